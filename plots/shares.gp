# shares.gp - which job loads which link: the busiest links as bars, each job's part of their busy time; a panel for each set of jobs.
data = figure.".csv"
stats data using (panels = int(column("panel")), machine = strcol("machine"), level = strcol("level"), 0) nooutput
stats data using (column("panel")) nooutput; panels = int(STATS_max)
stats data using (column("place")) nooutput; most = int(STATS_max)
stats data using (column("number")) nooutput; jobs = int(STATS_max)
stats data using (column("below") + column("share")) nooutput; top = STATS_max > 0 ? STATS_max : 1
array panel_name[panels]; array job_name[jobs]
do for [k=1:jobs] { job_name[k] = "" }
longest = 0
stats data using (panel_name[int(column("panel"))] = strcol("panel_name"), job_name[int(column("number"))] = strcol("job"), \
    longest = strlen(strcol("name")) > longest ? strlen(strcol("name")) : longest, 0) nooutput
in_panel(m, v) = column("panel") == m ? v : NaN
of_job(m, k, v) = column("panel") == m && column("number") == k ? v : NaN
columns = panels == 1 ? 1 : 2
rows = ceil(1.0*panels/columns)
bar_high = 20.0
left_px = 40.0 + 8.0*longest
panel_wide = columns == 1 ? 720.0 : 520.0
panel_high = most*bar_high + 58 + (panels > 1 ? 22 : 0)
wide = columns*panel_wide + 20
upper = 84.0
high = upper + rows*panel_high + 30 + foot_more(provenance, wide)
at_x(px) = px/wide; at_y(px) = 1.0 - px/high

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size int(2*wide),int(2*high) font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size int(wide),int(high) font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    set label 96 "Which job loads which link" at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 97 sprintf("the busiest links of the network, router → router; %s, level %s", machine, level) \
        at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, wide) at screen 0.99,at_y(high - foot_high(provenance, wide)) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.5,at_y(54) center top horizontal maxcols 6 samplen 1.2 width -1
    set grid xtics noytics; set border 1
    set xrange [0:100*top*1.02]; set yrange [most + 0.6:0.4]
    do for [m=1:panels] {
        c = (m - 1) % columns; r = (m - 1)/columns
        set lmargin at screen at_x(c*panel_wide + left_px); set rmargin at screen at_x((c + 1)*panel_wide - 12)
        panel_top = upper + r*panel_high + (panels > 1 ? 22 : 0)
        set tmargin at screen at_y(panel_top); set bmargin at screen at_y(panel_top + most*bar_high)
        if (panels > 1) { set title panel_name[m] noenhanced offset 0,-0.6 }
        set xtics nomirror out scale 0.6 autofreq offset 0,tick_lift(format)
        set xlabel "busy, share of the time until the last job has ended [%]" offset 0,name_lift(format)
        unset ytics
        plot for [k=1:jobs] data using (of_job(m, k, 100*column("below"))):"place":(100*column("below")):(100*(column("below") + column("share"))):(column("place") - 0.38):(column("place") + 0.38) \
                with boxxyerror fillcolor rgb colour[turn(k)] linewidth 0.4 notitle, \
             data using (in_panel(m, column("below") == 0 ? 0 : NaN)):"place":(strcol("name")) with labels right offset -0.6,0 noenhanced notitle, \
             for [k=1:(m == 1 ? jobs : 0)] keyentry with boxes fillcolor rgb colour[turn(k)] title job_name[k]
        unset label 96; unset label 97; unset label 99; unset key
    }
    unset multiplot
    unset output
}
