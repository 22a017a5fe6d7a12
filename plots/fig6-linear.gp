# fig6-linear.gp - speedup against n = P on linear axes with Amdahl's curves, as the paper draws it.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmax = STATS_max
stats data using "speedup" nooutput
smax = STATS_max
array name[last]
stats data using (name[int(column("series"))] = sprintf("over %s, %s operators: f = %.2f in the mean", strcol("baseline"), \
        strcol("operators"), column("fraction")), \
    headline = "Speedup of the complete dynamics, n = P, on ".strcol("machine").", on linear axes", \
    subline = strcol("formulation")." formulation, network level ".strcol("level")."; the first curve is the variant nearest to the paper", 0) nooutput
amdahl(f, p) = 1.0/((1.0 - f) + f/p)
fractions = "0.70 0.80 0.90 0.95 0.97 0.98"
of(k, v) = column("series") == k ? v : NaN
top = amdahl(0.98, pmax); top = (top > smax ? top : smax)*1.06

set samples 200
do for [format in formats] {
    page_wide = 800; page_high = 600
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title
    set lmargin at screen 0.085; set rmargin at screen 0.93; set tmargin at screen 0.765; set bmargin at screen 0.115
    set label 97 headline at screen 0.5,0.97 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.93 center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.08,0.905 left top vertical maxrows 3 samplen 3.5
    set xrange [0:pmax*1.02]; set yrange [0:top]
    set xtics offset 0,tick_lift(format)
    set xlabel "number of bodies = number of processors, n = P" offset 0,name_lift(format); set ylabel "speedup S"
    do for [i=1:words(fractions)] {
        f = real(word(fractions, i))
        set label 10+i sprintf("f = %.2f", f) at pmax*1.03,amdahl(f, pmax*1.02) left font small(format) textcolor rgb grey
    }
    # a point hides nothing: the curves have as many as there are runs
    plot for [i=1:words(fractions)] amdahl(real(word(fractions, i)), x < 1 ? 1 : x) with lines linewidth 0.9 linecolor rgb pale, \
         (x < 1 ? NaN : x) with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000", \
         for [k=last:1:-1] data using "P":(of(k, column("speedup"))) with lines linewidth 2 dashtype dash[turn(k)] \
            linecolor rgb colour[turn(k)], \
         for [k=last:1:-1] data using "P":(near(of(k, column("speedup")))):(sprintf("n = P = %d: speedup %.3g, f = %.3g", \
            column("P"), column("speedup"), column("parallel_fraction"))) with labels hypertext point \
            pointtype point[turn(k)] pointsize 0.8 linecolor rgb colour[turn(k)], \
         for [k=1:last] keyentry with linespoints linewidth 2 dashtype dash[turn(k)] pointtype point[turn(k)] \
            pointsize 0.8 linecolor rgb colour[turn(k)] title name[k]
    unset output
}
