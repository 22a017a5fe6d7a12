# speedup.gp - speedup against the number of ranks, a curve for each machine, with the ideal.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmin = STATS_min; pmax = STATS_max
stats data using "speedup" nooutput
smin = STATS_min; smax = STATS_max
array name[last]
stats data using (name[int(column("series"))] = strcol("curve"), \
    headline = "Speedup of ".strcol("program"), subline = "over ".strcol("baseline"), 0) nooutput
of(k, v) = column("series") == k ? v : NaN
ymin = smin < 1 ? smin*0.8 : 0.8
ymax = (pmax > smax ? pmax : smax)*1.15

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size 1600,1200 font png_font linewidth 2 enhanced } \
    else { set terminal svg size 800,600 font svg_font linewidth 1.2 enhanced }
    set output figure.".".format
    set label 1 headline at screen 0.5,0.97 center noenhanced font large(format)
    set label 2 subline at screen 0.5,0.925 center noenhanced textcolor rgb grey
    set label 3 provenance at screen 0.99,0.012 right noenhanced font least(format) textcolor rgb grey
    set lmargin at screen 0.1; set rmargin at screen 0.97; set tmargin at screen 0.89; set bmargin at screen 0.12
    set logscale x 2; set logscale y 2
    set xrange [pmin*0.9:pmax*1.12]; set yrange [ymin:ymax]
    set xlabel "ranks P"; set ylabel "speedup S"
    set key top left
    plot x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P", \
         1 with lines linewidth 0.6 linecolor rgb grey notitle, \
         for [k=1:last] data using "P":(of(k, column("speedup"))) with linespoints linewidth 1.6 \
            dashtype dash[k] pointtype point[k] pointsize 0.9 linecolor rgb colour[k] title name[k]
    unset output
}
