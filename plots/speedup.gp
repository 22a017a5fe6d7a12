# speedup.gp - speedup against the number of ranks, a curve for each machine, six a panel, with the ideal.
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

# six curves a panel
panels = int((last + 5)/6); across = panels > 1 ? 2 : 1; down = int((panels + across - 1)/across)
first(q) = 6*(q - 1) + 1
final(q) = 6*q < last ? 6*q : last
left = axis_px(letters_log(2, ymin, ymax))/(across == 1 ? 800.0 : 1000.0)
width = across == 1 ? 0.97 - left : (0.905 - left)/2

do for [format in formats] {
    high = 92.0 + (panels > 1 ? 430 : 500)*down; each = (high - 92.0)/down
    page_wide = across == 1 ? 800 : 1000; page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format
    set multiplot
    set label 97 headline at screen 0.5,(1.0 - 20/high) center noenhanced font large(format)
    set label 98 subline at screen 0.5,(1.0 - 44/high) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(9/high + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set logscale x 2; set logscale y 2
    set xrange [pmin*0.9:pmax*1.12]; set yrange [ymin:ymax]
    set xtics offset 0,tick_lift(format)
    set xlabel "ranks P" offset 0,name_lift(format); set ylabel "speedup S"
    set key top left
    do for [q=1:panels] {
        c = (q - 1) % across; r = int((q - 1)/across)
        set lmargin at screen left + c*(width + 0.08); set rmargin at screen left + c*(width + 0.08) + width
        set tmargin at screen 1.0 - (68.0 + each*r)/high; set bmargin at screen 1.0 - (68.0 + each*(r + 1) - 54)/high
        plot x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P", \
             1 with lines linewidth 0.6 linecolor rgb grey notitle, \
             for [k=first(q):final(q)] data using "P":(of(k, column("speedup"))) with lines linewidth 1.6 \
                dashtype dash[turn(k)] linecolor rgb colour[turn(k)], \
             for [k=first(q):final(q)] data using "P":(near(of(k, column("speedup")))):(sprintf("P = %d: speedup %.3g", column("P"), \
                column("speedup"))) with labels hypertext point pointtype point[turn(k)] pointsize 0.8 linecolor rgb colour[turn(k)], \
             for [k=first(q):final(q)] keyentry with linespoints linewidth 1.6 dashtype dash[turn(k)] pointtype point[turn(k)] \
                pointsize 0.8 linecolor rgb colour[turn(k)] title name[k]
        unset label 97; unset label 98; unset label 99
    }
    unset multiplot
    unset output
}
