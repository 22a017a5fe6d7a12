# pingpong.gp - one-way message time against size: a curve a machine, published points as symbols of the same colour.
# Six machines a panel, by the time of an empty message, so that each has a colour of its own there.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
array machine[last]
published = 0
stats data using (machine[int(column("series"))] = strcol("machine"), \
    published = published + (strcol("kind") eq "published"), 0) nooutput
stats data using "us" nooutput
low = 10**floor(log10(STATS_min)); high = 10**ceil(log10(STATS_max))
headline = last == 1 ? "Ping-pong on ".machine[1].": one-way time of a message" : \
    sprintf("Ping-pong on the %d machines of this database: one-way time of a message", last)
subline = published == 0 ? "curves: simulated" : \
    sprintf("curves: simulated; symbols: %d published points (hollow: class E, estimated)", published)
panels = int((last + 5)/6)
size = int((last + panels - 1)/panels)
first(p) = size*(p - 1) + 1
final(p) = size*p < last ? size*p : last
curve(k, v) = column("series") == k && strcol("kind") eq "simulated" ? v : NaN
read_again(k, v) = column("series") == k && strcol("kind") eq "published" && strcol("class") ne "E" ? v : NaN
estimated(k, v) = column("series") == k && strcol("kind") eq "published" && strcol("class") eq "E" ? v : NaN
place(k) = (int(k) - 1) % size + 1

set logscale xy
set xrange [3:8e6]
set yrange [low:high]
set xtics ("0" 4, "64" 64, "1 Ki" 1024, "16 Ki" 16384, "256 Ki" 262144, "4 Mi" 4194304)
set format y "10^{%T}"
across = panels < 4 ? panels : panels == 4 ? 2 : 3; down = int((panels + across - 1)/across)
left = across == 1 ? 0.1 : 0.085
gap = 0.03
width = (0.985 - left - gap*(across - 1))/across
do for [format in formats] {
    high = 110.0 + 400*down
    page_wide = int(across == 1 ? 760 : 1000); page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set xtics offset 0,tick_lift(format)
    do for [p=1:panels] {
        c = (p - 1) % across; r = int((p - 1)/across)
        set lmargin at screen left + c*(width + gap); set rmargin at screen left + c*(width + gap) + width
        set tmargin at screen 1.0 - (66.0 + 400*r)/high; set bmargin at screen 1.0 - (66.0 + 400*r + 344)/high
        if (p == 1) {
            set label 97 headline at screen 0.5,(1.0 - 20/high) center noenhanced font large(format)
            set label 98 subline at screen 0.5,(1.0 - 44/high) center noenhanced textcolor rgb grey
            set label 99 foot(provenance, page_wide) at screen 0.99,(9/high + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
        } else { unset label 97; unset label 98; unset label 99 }
        if (c == 0) { set ylabel "one way [µs]"; set format y "10^{%T}" } else { unset ylabel; set format y "" }
        set xlabel "message [B]" offset 0,name_lift(format)
        set key at graph 0.03, graph 0.985 left top vertical maxrows 6 samplen 2.6 font tiny
        plot for [k=first(p):final(p)] data using "shown_bytes":(curve(k, column("us"))) with lines linewidth 1.8 \
                dashtype dash[place(k)] linecolor rgb colour[place(k)], \
             for [k=first(p):final(p)] data using "shown_bytes":(read_again(k, column("us"))) with points \
                pointtype point[place(k)] pointsize 0.65 linecolor rgb colour[place(k)], \
             for [k=first(p):final(p)] data using "shown_bytes":(estimated(k, column("us"))) with points \
                pointtype hollow[place(k)] pointsize 0.65 linewidth 1.5 linecolor rgb colour[place(k)], \
             for [k=first(p):final(p)] keyentry with linespoints linewidth 1.8 dashtype dash[place(k)] pointtype point[place(k)] pointsize 0.7 \
                linecolor rgb colour[place(k)] title machine[k]
    }
    unset multiplot
    unset output
}
