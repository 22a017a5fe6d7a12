# roofline.gp - stages of one run as points under their roofs: computing, the port's bandwidth, message software.
data = figure.".csv"
stats data using (headline = strcol("title"), column("series")) nooutput
last = int(STATS_max)
array stage[last]
stats data using (stage[int(column("series"))] = strcol("stage"), column("peak")) nooutput
peak = STATS_max
stats data using "port" nooutput
port = STATS_records > 0 ? STATS_max : 0
stats data using "intensity" nooutput
left = 10**floor(log10(STATS_min/2)); right = 10**ceil(log10(STATS_max*2))
stats data using "attained" nooutput
low = 10**floor(log10(STATS_min/1.5)); high = 10**ceil(log10(peak*1.5))
subline = "a point is a stage; the bar above it is what message software allows there: below it, the stage waits"
only(k, v) = int(column("series")) == k ? v : NaN
set logscale xy
set xrange [left:right]
set yrange [low:high]
set samples 400
roof(x) = port > 0 && port*x < peak ? port*x : peak
do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size 1640,1120 font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size 820,560 font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format
    tiny = small(format)
    set title
    set lmargin at screen 0.1; set rmargin at screen 0.74; set tmargin at screen 0.885; set bmargin at screen 0.135
    set label 97 headline at screen 0.5,0.965 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.918 center noenhanced textcolor rgb grey font tiny
    set label 99 foot(provenance, 820) at screen 0.99,(0.016 + foot_lift(provenance, 820)*1.0/560) right noenhanced font least(format) textcolor rgb grey
    set xtics offset 0,tick_lift(format); set format x "10^{%T}"; set format y "10^{%T}"
    set xlabel "operations for each byte sent [flop/B]" offset 0,name_lift(format)
    set ylabel "one processor [Mflop/s]"
    set key at screen 0.755,0.885 left top vertical samplen 1.6 font tiny
    plot roof(x) with lines linewidth 2.2 linecolor rgb "#303030" title "port and computing", \
         data using "intensity":"software":(column("intensity")*0.88):(column("intensity")*1.136) with xerrorbars pointtype 0 \
            linewidth 2.2 linecolor rgb "#c43c10" title "message software", \
         data using "intensity":"attained":(0):(column("software") - column("attained")) with vectors nohead linewidth 0.7 \
            dashtype 3 linecolor rgb grey notitle, \
         for [k=1:last] data using (only(k, column("intensity"))):(only(k, column("attained"))) with points pointsize 1.1 \
            pointtype (k > 6 ? hollow[turn(k)] : point[turn(k)]) linewidth 1.6 linecolor rgb colour[turn(k)] title stage[k]
    unset output
}
