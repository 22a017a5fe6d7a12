# why.gp - what limits a run: three lists of bars side by side, each with its own scale.
data = figure.".csv"
array rows[3] = [0, 0, 0]
array most[3] = [1e-9, 1e-9, 1e-9]
stats data using (p = int(column("panel")), rows[p] = column("y") > rows[p] ? column("y") : rows[p], \
    most[p] = column("time_us") > most[p] ? column("time_us") : most[p], headline = strcol("title"), 0) nooutput
subline = "the critical path is the chain of operations that ends last: only what shortens it makes the run faster"
wide = 1200.0; upper = 118.0; row_high = 36.0
n = rows[1] > rows[2] ? rows[1] : rows[2]
n = n > rows[3] ? n : rows[3]
total = upper + row_high*n + 84
at_x(px) = px/wide; at_y(px) = 1.0 - px/total
array names[3] = ["The path by stage and cause", "What a parameter of the machine stands for", "On idealised machines"]
array left_px[3] = [168.0, 560.0, 960.0]
array right_px[3] = [376.0, 780.0, 1190.0]
array fill[3] = [colour[1], colour[4], colour[3]]
is(c) = column("panel") == c

do for [format in formats] {
    page_wide = int(wide); page_high = int(total)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel; unset key
    tiny = format eq "png" ? ",16" : ",11"
    set multiplot
    set label 97 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(44) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    unset ytics
    set yrange [n + 0.55:0.45]
    set tmargin at screen at_y(upper); set bmargin at screen at_y(upper + row_high*n)
    do for [c=1:3] {
        set lmargin at screen at_x(left_px[c]); set rmargin at screen at_x(right_px[c])
        # room for a number right of the longest bar
        set xrange [0:2.1*most[c]]
        set xtics 0,most[c],most[c] format "%.4g" offset 0,tick_lift(format)
        set xlabel "time [µs]" offset 0,name_lift(format)
        set label 96 names[c] at screen at_x(left_px[c]),at_y(upper - 16) left noenhanced
        plot data using (is(c) ? column("time_us")/2.0 : NaN):"y":(abs(column("time_us"))/2.0):(0.32) with boxxyerror fillcolor rgb fill[c] linewidth 0.3 notitle, \
             data using (is(c) ? (column("time_us") > 0 ? column("time_us") : 0) + 0.03*most[c] : NaN):(column("y") - (strlen(strcol("other")) > 0 ? 0.17 : 0)):(strcol("label")) with labels left noenhanced font tiny, \
             data using (is(c) ? (column("time_us") > 0 ? column("time_us") : 0) + 0.03*most[c] : NaN):(column("y") + 0.22):(strcol("other")) with labels left noenhanced font tiny textcolor rgb grey, \
             NaN notitle
        unset label 96; unset label 97; unset label 98; unset label 99
    }
    set lmargin at screen 0; set rmargin at screen 1
    unset border; unset xtics; unset xlabel; unset grid
    set xrange [0:wide]
    plot for [c=1:3] data using (is(c) ? left_px[c] - 8 : NaN):"y":(strcol("what")) with labels right noenhanced font tiny
    set border 3 linewidth 0.8; set xtics nomirror out scale 0.6; set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
    unset multiplot
    unset output
}
