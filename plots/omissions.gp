# omissions.gp - what leaving out saves: a row for each omission, left the host's time, right the predicted machine's.
data = figure.".csv"
stats data using "y" nooutput
n = int(STATS_max)
host_most = 1e-9; host_least = 0; machine_most = 1e-9; machine_least = 0; bounded = 0
stats data using (h = column("host_saved_ms"), m = column("machine_saved_us"), \
    host_most = h > host_most ? h : host_most, host_least = h < host_least ? h : host_least, \
    machine_most = m > machine_most ? m : machine_most, machine_least = m < machine_least ? m : machine_least, \
    headline = "What leaving out saves: ".strcol("scenario"), 0) nooutput
subline = "time of the same run with the omission undone, minus that of the run with the omission; shortest of repeats taken in turn"
exact_colour = colour[1]; bounded_colour = colour[4]; noise_colour = "#d0d0d0"
wide = 1100.0; upper = 122.0; row_high = 40.0
total = upper + row_high*n + 84
at_x(px) = px/wide; at_y(px) = 1.0 - px/total
array cost[2] = ["host_saved_ms", "machine_saved_us"]
array words_of[2] = ["host_text", "machine_text"]
array axis_name[2] = ["time of this computer saved [ms]", "predicted time of the machine saved [µs]"]
array left_px[2] = [330.0, 730.0]
array right_px[2] = [700.0, 1084.0]
is(c, b) = column("measured") == 1 && column("bounded") == b && (c == 2 || column("told") == 1)

do for [format in formats] {
    page_wide = int(wide); page_high = int(total)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = format eq "png" ? ",16" : ",11"
    set multiplot
    set label 97 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(44) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set lmargin at screen 0.05; set rmargin at screen 0.98; set tmargin at screen 0.9; set bmargin at screen 0.1
    unset border; unset xtics; unset ytics; unset xlabel; unset grid
    set xrange [0:1]; set yrange [0:1]
    set key at screen at_x(wide/2),at_y(62) center top horizontal maxrows 1 samplen 1.2 width 1
    plot NaN, keyentry with boxes linewidth 0.3 fillcolor rgb exact_colour title "exact: the same bits", \
         keyentry with boxes linewidth 0.3 fillcolor rgb bounded_colour title "bounded: within its bound", \
         keyentry with boxes linewidth 0.3 fillcolor rgb noise_colour title "below the noise"
    unset key; unset label 97; unset label 98; unset label 99
    set border 3 linewidth 0.8; set grid xtics linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
    set xtics nomirror out scale 0.6 offset 0,tick_lift(format)
    set yrange [n + 0.55:0.45]
    set tmargin at screen at_y(upper); set bmargin at screen at_y(upper + row_high*n)
    do for [c=1:2] {
        most = c == 1 ? host_most : machine_most; least = c == 1 ? host_least : machine_least
        set lmargin at screen at_x(left_px[c]); set rmargin at screen at_x(right_px[c])
        # room for a number right of the longest bar
        set xrange [1.12*least:1.62*most]
        set xtics autofreq
        if (most <= 1e-9) { set xrange [0:1]; set xtics (0) }
        set xlabel axis_name[c] offset 0,name_lift(format)
        plot data using (is(c, 0) ? column(cost[c])/2.0 : NaN):"y":(abs(column(cost[c]))/2.0):(0.3) with boxxyerror fillcolor rgb exact_colour linewidth 0.3, \
             data using (is(c, 1) ? column(cost[c])/2.0 : NaN):"y":(abs(column(cost[c]))/2.0):(0.3) with boxxyerror fillcolor rgb bounded_colour linewidth 0.3, \
             data using (column("measured") == 1 && c == 1 && column("told") == 0 ? column(cost[c])/2.0 : NaN):"y":(abs(column(cost[c]))/2.0):(0.3) with boxxyerror \
                fillcolor rgb noise_colour linewidth 0.3, \
             data using ((column("measured") == 1 && column(cost[c]) > 0 ? column(cost[c]) : 0) + 0.02*most):"y":(strcol(words_of[c])) with labels left noenhanced font tiny, \
             NaN notitle
        unset label 97; unset label 98; unset label 99
    }
    set lmargin at screen 0; set rmargin at screen 1
    unset border; unset xtics; unset xlabel; unset grid; unset key
    set xrange [0:wide]
    plot data using (320):(column("y") - 0.2):(strcol("what")) with labels right noenhanced font tiny, \
         data using (320):(column("y") + 0.2):(strcol("class_text")) with labels right noenhanced font tiny textcolor rgb grey
    set border 3 linewidth 0.8; set xtics nomirror out scale 0.6
    unset multiplot
    unset output
}
