# _heat.gp - a column over two others: a cell for each pair of their values, with the number in it where there is room.
data = figure.".csv"; about = figure.".about.csv"
bands = ""; xlabel = ""; ylabel = ""; vlabel = ""
stats about using (headline = strcol("title"), subline = strcol("subtitle"), bands = strcol("bands"), \
    xlabel = strcol("xlabel"), ylabel = strcol("ylabel"), vlabel = strcol("vlabel"), vscale = column("vscale"), \
    vlog = int(column("vlog")), panels = int(column("panels")), nx = int(column("nx")), ny = int(column("ny")), 0) nooutput
array panel_name[panels]
longest_y = 0
stats data using (panel_name[int(column("panel"))] = strcol("panel_name"), \
    longest_y = strlen(strcol("y_text")) > longest_y ? strlen(strcol("y_text")) : longest_y, 0) nooutput
stats data using (column("value")*vscale) nooutput
vmin = STATS_min; vmax = STATS_max; if (vmin == vmax) { vmax = vmin + (vmin == 0 ? 1 : abs(vmin)*0.01) }
in_panel(m, v) = column("panel") == m ? v : NaN
# from dark to light, as cividis: the order shows in grey and to colour-blind readers
set palette defined (0 "#00224e", 0.25 "#414d6b", 0.5 "#7c7b78", 0.75 "#bcae6c", 1 "#fee838")
share(v) = vlog > 0 ? (log(v) - log(vmin))/(log(vmax) - log(vmin)) : (v - vmin)/(vmax - vmin)
ink(v) = share(v) < 0.55 ? 0xffffff : 0x000000
numbers = nx <= 14 && nx*ny <= 196
columns = panels == 1 ? 1 : 2
rows = ceil(1.0*panels/columns)
cell_wide = nx <= 14 ? 58.0 : 800.0/nx; cell_high = ny <= 20 ? 30.0 : 600.0/ny
left_px = 40.0 + 8.2*(longest_y > 30 ? 30 : longest_y)
panel_wide = left_px + nx*cell_wide + 112
panel_high = ny*cell_high + 70 + (panels > 1 ? 22 : 0)
wide = columns*panel_wide < 640 ? 640.0 : columns*panel_wide
upper = 78.0 + (strlen(bands) > 0 ? 18 : 0)
high = upper + rows*panel_high + 30 + foot_more(provenance, wide)
shift = (wide - columns*panel_wide)/2
at_x(px) = (px + shift)/wide; at_y(px) = 1.0 - px/high

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size int(2*wide),int(2*high) font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size int(wide),int(high) font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel; unset key
    tiny = small(format)
    set multiplot
    set label 96 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 97 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 95 "colours and numbers: ".vlabel at screen 0.5,at_y(62) center noenhanced font small(format) textcolor rgb grey
    set label 98 bands at screen 0.5,at_y(80) center noenhanced font small(format) textcolor rgb grey
    set label 99 foot(provenance, wide) at screen 0.99,at_y(high - foot_high(provenance, wide)) right noenhanced font least(format) textcolor rgb grey
    unset grid; set border 0
    set cbrange [vmin:vmax]; if (vlog > 0) { set logscale cb 10 }
    set format cb "%.4g"
    set xrange [0.5:nx + 0.5]; set yrange [0.5:ny + 0.5]
    set xtics () scale 0 offset 0,tick_lift(format) rotate by (nx > 14 ? -60 : 0); set ytics () scale 0
    do for [m=1:panels] {
        c = (m - 1) % columns; r = (m - 1)/columns
        set lmargin at screen at_x(c*panel_wide + left_px + 20); set rmargin at screen at_x(c*panel_wide + left_px + 20 + nx*cell_wide)
        top = upper + r*panel_high + (panels > 1 ? 22 : 4)
        set tmargin at screen at_y(top); set bmargin at screen at_y(top + ny*cell_high)
        set xlabel xlabel noenhanced offset 0,name_lift(format); set ylabel ylabel noenhanced
        if (panels > 1) { set title panel_name[m] noenhanced offset 0,-0.6 }
        plot data using (in_panel(m, column("xi"))):"yi":(0.48):(0.48):(column("value")*vscale) \
                with boxxyerror fillcolor palette linewidth 0 notitle, \
             data using (numbers ? in_panel(m, column("xi")) : NaN):"yi":(sprintf("%.3g", column("value")*vscale)):(ink(column("value")*vscale)) \
                with labels center noenhanced font tiny textcolor rgb variable notitle, \
             figure.".x.csv" using "xi":(1):xticlabels(strcol("x_text")) with points pointsize 0 notitle, \
             figure.".y.csv" using (1):"yi":yticlabels(strcol("y_text")) with points pointsize 0 notitle
        unset label 95; unset label 96; unset label 97; unset label 98; unset label 99
    }
    unset multiplot
    unset output
}
