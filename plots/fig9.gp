# fig9.gp - speedup for several numbers of bodies per processor; left over the same code, right over the fastest serial.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmin = STATS_min; pmax = STATS_max
stats data using "speedup" nooutput
smin = STATS_min
array ratio[last]
stats data using (ratio[int(column("series"))] = column("bodies_per_processor"), \
    headline = "Speedup of the complete dynamics with n/P bodies per processor, on ".strcol("machine"), \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators, network level ".strcol("level"), 0) nooutput
array over[2] = ["over the parallel code on one processor", "over the fastest serial code"]
of(p, k, v) = column("panel") == p && column("series") == k ? v : NaN
ymin = 2**floor(log(smin)/log(2)); if (ymin > 0.5) { ymin = 0.5 }

set logscale x 2
set samples 200
set xrange [pmin*0.9:pmax*1.12]
set xtics (2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096)
do for [format in formats] {
    page_wide = 800; page_high = 660
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # the legend, in a frame as wide as the page
    set lmargin at screen 0.05; set rmargin at screen 0.99; set tmargin at screen 0.9; set bmargin at screen 0.2
    unset border; unset tics; unset logscale; set yrange [0:1]
    set label 97 headline at screen 0.5,0.975 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.943 center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.53,0.925 center top horizontal maxrows (last > 5 ? 2 : 1) samplen 3 width -1
    plot NaN, for [k=1:last] keyentry with linespoints linewidth 1.8 dashtype dash[turn(k)] pointtype (k > 6 ? hollow[turn(k)] : point[turn(k)]) pointsize 0.8 \
            linecolor rgb colour[turn(k)] title sprintf("n/P = %d", ratio[k]), \
         keyentry with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P"
    unset key; unset label 97; unset label 98; unset label 99
    set border 3
    do for [p=1:2] {
        set lmargin at screen (p == 1 ? 0.105 : 0.59); set rmargin at screen (p == 1 ? 0.495 : 0.985)
        set tmargin at screen 0.81; set bmargin at screen 0.42
        set xtics nomirror out scale 0.6 offset 0,tick_lift(format); set ytics nomirror out scale 0.6
        set logscale x 2; set logscale y 2
        set format x ""
        set yrange [ymin:pmax*1.1]
        set ytics ("1/64" 1.0/64, "1/32" 1.0/32, "1/16" 1.0/16, "1/8" 0.125, "1/4" 0.25, "1/2" 0.5, 1, 2, 4, 8, 16, 32, \
                   64, 128, 256, 512, 1024, 2048, 4096)
        set xlabel ""
        set ylabel (p == 1 ? "speedup S" : "")
        set title over[p] offset 0,-0.6
        plot x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000", \
             for [k=1:last] data using "P":(of(p, k, column("speedup"))) with linespoints linewidth 1.8 dashtype dash[turn(k)] \
                pointtype (k > 6 ? hollow[turn(k)] : point[turn(k)]) pointsize 0.8 linecolor rgb colour[turn(k)]
        unset title
        set tmargin at screen 0.39; set bmargin at screen 0.125
        unset logscale y
        set format x "%g"
        set yrange [0:1.02]
        set ytics 0,0.2,1 format "%.1f"
        set ylabel (p == 1 ? "degree of parallelism f" : "")
        set xlabel "number of processors P" offset 0,name_lift(format)
        plot 0.97 with lines linewidth 0.8 linecolor rgb grey, \
             for [k=1:last] data using "P":(of(p, k, column("parallel_fraction"))) with linespoints linewidth 1.8 \
                dashtype dash[turn(k)] pointtype (k > 6 ? hollow[turn(k)] : point[turn(k)]) pointsize 0.8 linecolor rgb colour[turn(k)]
        set format y "%g"
    }
    unset multiplot
    unset output
}
