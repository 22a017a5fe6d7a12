# fig6.gp - speedup against n = P with Amdahl's curves; degree of parallelism of each point; cost of contention.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmin = STATS_min; pmax = STATS_max
stats data using "speedup" nooutput
smin = STATS_min
array name[last + 1]; name[last + 1] = "" # gnuplot evaluates the first element of an empty loop, too
excess = 1
stats data using (name[int(column("series"))] = strcol("baseline"), \
    headline = "Speedup of the complete dynamics, n = P, on ".strcol("machine"), \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators, network level ".strcol("level"), \
    excess = column("contention_percent") > excess ? column("contention_percent") : excess, 0) nooutput

amdahl(f, p) = 1.0/((1.0 - f) + f/p)
fractions = "0.70 0.80 0.90 0.95 0.97 0.98"
has_band = name[1] eq "fastest serial"
first = has_band ? 2 : 1
rows = ceil((last + 2)/2.0)
top = 0.92 - 0.027*rows
of(k, v) = column("series") == k ? v : NaN
ymin = 2**floor(log(smin)/log(2)); if (ymin > 0.5) { ymin = 0.5 }

set logscale x 2
set samples 200
set xrange [pmin*0.93:pmax*1.07]
set xtics (2, 3, 4, 6, 8, 12, 16, 24, 32, 45, "" 48, 64, 96, 128, 192, 256, 384, 512, 1024, 2048, 4096)
do for [format in formats] {
    page_wide = 800; page_high = 860
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    set lmargin at screen 0.105; set rmargin at screen 0.93
    # speedup
    set tmargin at screen top; set bmargin at screen 0.475
    set label 97 headline at screen 0.5,0.98 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.953 center noenhanced textcolor rgb grey
    set key at screen 0.52,0.93 center top vertical maxrows rows samplen 3.5 width -1
    set xtics offset 0,tick_lift(format); set logscale y 2
    set yrange [ymin:pmax*1.1]
    set ytics ("1/64" 1.0/64, "1/32" 1.0/32, "1/16" 1.0/16, "1/8" 0.125, "1/4" 0.25, "1/2" 0.5, 1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
    set ylabel "speedup S over the serial code"
    set xlabel ""
    set format x ""
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    do for [i=1:words(fractions)] {
        f = real(word(fractions, i))
        set label 10+i sprintf("%.2f", f) at pmax*1.09,amdahl(f, pmax) left font small(format) textcolor rgb grey
    }
    set label 20 "f =" at pmax*1.09,amdahl(0.98, pmax)*1.4 left font small(format) textcolor rgb grey
    plot for [i=1:words(fractions)] amdahl(real(word(fractions, i)), x) with lines linewidth 0.8 linetype 1 \
            linecolor rgb pale title i == 1 ? "Amdahl's law for f" : '', \
         x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P", \
         data using "P":(has_band ? of(1, column("speedup")) : NaN) with lines linewidth 6 linecolor rgb band title "over ".name[1], \
         for [k=first:last] data using "P":(of(k, column("speedup"))) with lines linewidth 1.8 dashtype dash[turn(k-first+1)] \
            linecolor rgb colour[turn(k-first+1)], \
         for [k=first:last] data using "P":(near(of(k, column("speedup")))):(sprintf("n = P = %d: speedup %.3g, f = %.3g", \
            column("P"), column("speedup"), column("parallel_fraction"))) with labels hypertext point \
            pointtype point[turn(k-first+1)] pointsize 0.8 linecolor rgb colour[turn(k-first+1)], \
         for [k=first:last] keyentry with linespoints linewidth 1.8 dashtype dash[turn(k-first+1)] \
            pointtype point[turn(k-first+1)] pointsize 0.8 linecolor rgb colour[turn(k-first+1)] title "over ".name[k]
    do for [i=1:words(fractions)] { unset label 10+i }
    unset label 20; unset label 99; unset label 97; unset label 98
    # degree of parallelism
    set tmargin at screen 0.455; set bmargin at screen 0.235
    unset key
    unset logscale y
    set yrange [0:1.01]
    set ytics 0,0.2,1 format "%.1f"
    set ylabel "degree of parallelism f"
    set label 21 "0.97" at pmax*1.09,0.97 left font small(format) textcolor rgb grey
    plot 0.97 with lines linewidth 0.8 linecolor rgb grey, \
         data using "P":(has_band ? of(1, column("parallel_fraction")) : NaN) with lines linewidth 6 linecolor rgb band, \
         for [k=first:last] data using "P":(of(k, column("parallel_fraction"))) with linespoints linewidth 1.8 dashtype dash[turn(k-first+1)] \
            pointtype point[turn(k-first+1)] pointsize 0.8 linecolor rgb colour[turn(k-first+1)]
    unset label 21
    # contention
    set tmargin at screen 0.215; set bmargin at screen 0.095
    set yrange [0:excess*1.15]
    set ytics autofreq format "%g"
    set ytics add 0,(excess > 20 ? 10 : excess > 8 ? 5 : excess > 3 ? 2 : 0.5)
    set ylabel "contention [%]"
    set xlabel "number of bodies = number of processors, n = P" offset 0,name_lift(format)
    set format x "%g"
    plot 0 with lines linewidth 0.4 linecolor rgb grey, \
         data using "P":(of(1, column("contention_percent"))) with linespoints linewidth 1.8 pointtype 2 pointsize 0.8 \
            linecolor rgb "#000000"
    unset multiplot
    unset output
}
