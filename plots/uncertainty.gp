# uncertainty.gp - predicted times with the band of the machine's parameters, and the parameters' shares of the variance.
data = figure.".csv"; shares = figure.".shares.csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "x" nooutput
xmin = STATS_min; xmax = STATS_max
stats data using "low_ms" nooutput
ymin = STATS_min
stats data using "high_ms" nooutput
ymax = STATS_max
array name[last]; axis = ""; samples = 0
stats data using (name[int(column("series"))] = strcol("curve"), axis = strcol("axis"), samples = column("samples"), \
    headline = "Predicted time of ".strcol("scenario").", as far as the machine is known", 0) nooutput
subline = sprintf("bands: 90 %% of %d samples of the machine's uncertain parameters", samples)
# without shares there is nothing below: the file has its head only
parameters = 0
set datafile nocolumnheaders
stats shares using (parameters = parameters + 1, 1) every ::1 nooutput
set datafile columnheaders
of(k, v) = column("series") == k ? v : NaN
wide = xmax > xmin && axis ne "run"
steep = ymax > 5*ymin

do for [format in formats] {
    below = parameters > 0 ? 96.0 + 26*parameters : 0
    high = 480.0 + below
    page_wide = 800; page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format
    set multiplot
    set label 97 headline at screen 0.5,(1.0 - 20/high) center noenhanced font large(format)
    set label 98 subline at screen 0.5,(1.0 - 44/high) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(9/high + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    # times
    set lmargin at screen wider(84.0, axis_px(steep ? letters_log(10, ymin/1.2, ymax*1.2) : letters_even(0, ymax*1.08)))/page_wide; set rmargin at screen 0.97
    set tmargin at screen 1.0 - (68.0 + 20*last)/high; set bmargin at screen (below + 78)/high
    if (wide) { set logscale x 2; set xrange [xmin*0.9:xmax*1.12] } else { set xrange [xmin - 0.6:xmax + 0.6]; set xtics 1 }
    if (steep) { set logscale y; set yrange [ymin/1.2:ymax*1.2] } else { set yrange [0:ymax*1.08] }
    set xtics offset 0,tick_lift(format)
    set xlabel axis offset 0,name_lift(format); set ylabel "time [ms]"
    set key at screen 0.105,(1.0 - 58/high) left top vertical
    plot for [k=1:last] data using "x":(of(k, column("low_ms"))):"high_ms" with filledcurves fillstyle transparent solid 0.18 noborder \
            linecolor rgb colour[turn(k)], \
         for [k=1:last] data using "x":(of(k, column("nominal_ms"))):"low_ms":"high_ms" with yerrorbars linewidth 1.2 pointtype 0 \
            linecolor rgb colour[turn(k)], \
         for [k=1:last] data using "x":(of(k, column("nominal_ms"))) with lines linewidth 1.6 dashtype dash[turn(k)] linecolor rgb colour[turn(k)], \
         for [k=1:last] data using "x":(of(k, column("nominal_ms"))):(sprintf("%s = %g: %.4g ms, 90 %% between %.4g and %.4g ms", axis, \
            column("x"), column("nominal_ms"), column("low_ms"), column("high_ms"))) with labels hypertext point \
            pointtype point[turn(k)] pointsize 0.8 linecolor rgb colour[turn(k)], \
         for [k=1:last] keyentry with linespoints linewidth 1.6 dashtype dash[turn(k)] pointtype point[turn(k)] \
            pointsize 0.8 linecolor rgb colour[turn(k)] title name[k]
    unset label 97; unset label 98; unset label 99
    # shares
    if (parameters > 0) {
        unset logscale; unset key
        set lmargin at screen 0.42; set rmargin at screen 0.97
        set tmargin at screen (below - 8)/high; set bmargin at screen 76/high
        set xrange [0:*]; set yrange [parameters + 0.6:0.4]
        set xtics autofreq; unset ylabel; set ytics offset 0,0 noenhanced
        set xlabel "share of the variance [%]: bar with interactions, dot alone" offset 0,name_lift(format)
        plot shares using (column("total_percent") > 0 ? column("total_percent")/2 : 0):"place":(column("total_percent") > 0 ? column("total_percent")/2 : 0):(0.36):yticlabels(2) \
                with boxxyerror fillcolor rgb "#b9cbe4" fillstyle solid 1 border linecolor rgb "#7f9cc4", \
             shares using "total_percent":"place":"total_error_percent" with xerrorbars linewidth 1 pointtype 0 linecolor rgb "#4a6a9c", \
             shares using (column("first_percent") > 0 ? column("first_percent") : 0):"place" with points pointtype 7 pointsize 0.7 \
                linecolor rgb colour[2]
    }
    unset multiplot
    unset output
    set xtics autofreq; set ytics autofreq
}
