# fig9-machines.gp - speedup for several numbers of bodies per processor on several machines, one panel each.
data = figure.".csv"
same = figure.".coincide.csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "panel" nooutput
panels = int(STATS_max); lines = int((panels + 1)/2)
array ratio[last]; array machine[panels]; array note[panels]
array pmin[lines]; array pmax[lines]; array smin[lines]; array smax[lines]
do for [i=1:panels] { note[i] = "" }
do for [i=1:lines] { pmin[i] = 1e30; pmax[i] = 0; smin[i] = 1e30; smax[i] = 0 }
array most[panels]; do for [i=1:panels] { most[i] = 0 }
# two machines a row, whose axes are the same
stats data using (m = int(column("panel")), line = int((m + 1)/2), p = column("P"), s = column("speedup"), \
    pmin[line] = p < pmin[line] ? p : pmin[line], pmax[line] = p > pmax[line] ? p : pmax[line], smin[line] = s < smin[line] ? s : smin[line], \
    smax[line] = s > smax[line] ? s : smax[line], most[m] = p > most[m] ? p : most[m], \
    ratio[int(column("series"))] = column("bodies_per_processor"), \
    machine[m] = strcol("machine").", level ".strcol("level"), \
    headline = sprintf("Speedup with n/P bodies per processor, on %d machines", panels), \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators, over the parallel code on one processor", 0) nooutput
stats same using (m = int(column("panel")), m > 0 ? (note[m] = strcol("text"), 0) : 0) nooutput
of(m, k, v) = column("panel") == m && column("series") == k ? v : NaN
first = 1

set samples 200
do for [format in formats] {
    high = 114 + 318.0*lines + 44
    page_wide = 900; page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # the legend, in a frame as wide as the page
    set lmargin at screen 0.05; set rmargin at screen 0.99; set tmargin at screen 0.9; set bmargin at screen 0.2
    unset border; unset tics; unset logscale; set xrange [0:1]; set yrange [0:1]
    set label 97 headline at screen 0.5,(1.0 - 18/high) center noenhanced font large(format)
    set label 98 subline at screen 0.5,(1.0 - 42/high) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(8/high + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.53,(1.0 - 56/high) center top horizontal maxrows 2 samplen 3 width 0
    plot NaN, for [k=1:last] keyentry with linespoints linewidth 1.8 dashtype dash[turn(k)] pointtype point[turn(k)] pointsize 0.8 \
            linecolor rgb colour[turn(k)] title sprintf("n/P = %d", ratio[k]), \
         keyentry with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P"
    unset key; unset label 97; unset label 98; unset label 99
    set border 3
    set logscale x 2; set logscale y 2
    set xtics nomirror out scale 0.6; set ytics nomirror out scale 0.6
    set ytics ("1/1024" 1.0/1024, "1/512" 1.0/512, "1/256" 1.0/256, "1/128" 1.0/128, "1/64" 1.0/64, "1/32" 1.0/32, "1/16" 1.0/16, "1/8" 1.0/8, \
               "1/4" 0.25, "1/2" 0.5, 1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024)
    set xtics (2, 3, 4, 6, 8, 12, 16, 32, 64, 128, 256, 512, 1024) offset 0,tick_lift(format)
    set xlabel "number of processors P" offset 0,name_lift(format)
    do for [m=1:panels] {
        left = m % 2 == 1; line = int((m + 1)/2)
        set lmargin at screen (left ? 0.1 : 0.59); set rmargin at screen (left ? 0.49 : 0.985)
        set tmargin at screen 1.0 - (114 + 318*(line - 1) + 24)/high; set bmargin at screen 1.0 - (114 + 318*line - 58)/high
        set xrange [pmin[line]*0.94:pmax[line]*1.06]; set yrange [smin[line]*0.8:smax[line]*1.3]
        set ylabel (left ? "speedup S" : "")
        set title machine[m].(most[m] < pmax[line] ? sprintf(", %d processors at most", most[m]) : "") noenhanced offset 0,-0.7
        set label 1 note[m] at graph 0.99,0.04 right noenhanced font small(format) textcolor rgb grey
        plot x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000", \
             1 with lines linewidth 0.6 linecolor rgb grey, \
             for [k=first:last] data using "P":(of(m, k, column("speedup"))) with lines linewidth 1.6 \
                dashtype dash[turn(k-first+1)] linecolor rgb colour[turn(k-first+1)], \
             for [k=first:last] data using "P":(near(of(m, k, column("speedup")))):(sprintf("P = %d: speedup %.3g, f = %.3g", \
                column("P"), column("speedup"), column("parallel_fraction"))) with labels hypertext point \
                pointtype point[turn(k-first+1)] pointsize 0.7 linecolor rgb colour[turn(k-first+1)]
    }
    unset label 1
    unset multiplot
    unset output
}
