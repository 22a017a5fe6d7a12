# interference.gp - how much longer each job (a row) takes beside another one (a column): a matrix for each set of jobs.
data = figure.".csv"
stats data using (panels = int(column("panel")), machine = strcol("machine"), level = strcol("level"), 0) nooutput
stats data using (column("panel")) nooutput; panels = int(STATS_max)
stats data using (column("xi")) nooutput; nx = int(STATS_max)
stats data using (column("yi")) nooutput; ny = int(STATS_max)
stats data using (column("slowdown")) nooutput; top = STATS_max > 1.02 ? STATS_max : 1.02
array panel_name[panels]
longest = 0
stats data using (panel_name[int(column("panel"))] = strcol("panel_name"), \
    longest = strlen(strcol("job")) > longest ? strlen(strcol("job")) : longest, 0) nooutput
in_panel(m, v) = column("panel") == m ? v : NaN
# from white, where nothing is disturbed, to dark: the order shows in grey, too
set palette defined (0 "#f6f6f6", 0.3 "#f0c368", 0.65 "#d06a2c", 1 "#6b2346")
ink(v) = v < 1 + 0.5*(top - 1) ? 0x000000 : 0xffffff
columns = panels == 1 ? 1 : 2
rows = ceil(1.0*panels/columns)
cell_wide = 78.0; cell_high = 34.0
left_px = 50.0 + 8.2*(longest > 24 ? 24 : longest)
panel_wide = left_px + nx*cell_wide + 30
panel_high = ny*cell_high + 84 + (panels > 1 ? 22 : 0)
wide = columns*panel_wide + 90 < 640 ? 640.0 : columns*panel_wide + 90
upper = 76.0
high = upper + rows*panel_high + 30 + foot_more(provenance, wide)
at_x(px) = px/wide; at_y(px) = 1.0 - px/high
shift = (wide - 90 - columns*panel_wide)/2

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size int(2*wide),int(2*high) font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size int(wide),int(high) font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel; unset key
    tiny = small(format)
    set multiplot
    set label 96 "How much longer jobs take beside each other" at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 97 sprintf("makespan of the job over its makespan alone on the same processors; %s, level %s", machine, level) \
        at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, wide) at screen 0.99,at_y(high - foot_high(provenance, wide)) right noenhanced font least(format) textcolor rgb grey
    unset grid; set border 0
    set cbrange [1:top]
    set format cb "%.2f"
    # as many numbers beside the bar of colours as there is room for
    step = 0.01
    do for [next in "0.02 0.05 0.1 0.2 0.5 1 2 5 10 20 50 100 200 500"] { if ((top - 1)/step > ny*cell_high/22) { step = real(next) } }
    set cbtics 1,step
    set xrange [0.5:nx + 0.5]; set yrange [0.5:ny + 0.5]
    set xtics () scale 0 offset 0,tick_lift(format); set ytics () scale 0
    do for [m=1:panels] {
        c = (m - 1) % columns; r = (m - 1)/columns
        left = shift + c*panel_wide + left_px
        set lmargin at screen at_x(left); set rmargin at screen at_x(left + nx*cell_wide)
        panel_top = upper + r*panel_high + (panels > 1 ? 22 : 4)
        set tmargin at screen at_y(panel_top); set bmargin at screen at_y(panel_top + ny*cell_high)
        set xlabel "beside" noenhanced offset 0,name_lift(format); set ylabel ""
        if (panels > 1) { set title panel_name[m] noenhanced offset 0,-0.6 }
        if (m == 1) { set colorbox user origin screen at_x(wide - 76),at_y(upper + 4 + ny*cell_high) size screen 16.0/wide,(ny*cell_high)/high } \
        else { unset colorbox }
        plot data using (in_panel(m, column("xi"))):"yi":(0.48):(0.47):"slowdown" \
                with boxxyerror fillcolor palette linewidth 0 notitle, \
             data using (in_panel(m, column("xi"))):"yi":(sprintf("%.2f", column("slowdown"))):(ink(column("slowdown"))) \
                with labels center noenhanced font tiny textcolor rgb variable notitle, \
             figure.".x.csv" using "xi":(1):xticlabels(strcol("name")) with points pointsize 0 notitle, \
             figure.".y.csv" using (1):"yi":yticlabels(strcol("name")) with points pointsize 0 notitle
        unset label 96; unset label 97; unset label 99
    }
    unset multiplot
    unset output
}
