# pingpong.gp - one-way message time against size: a curve a machine, published points as symbols of the same colour.
# Eight machines a panel, by the time of an empty message, so that each has a colour of its own there.
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
panels = int((last + 7)/8)
size = int((last + panels - 1)/panels)
first(p) = size*(p - 1) + 1
final(p) = size*p < last ? size*p : last
curve(k, v) = column("series") == k && strcol("kind") eq "simulated" ? v : NaN
read_again(k, v) = column("series") == k && strcol("kind") eq "published" && strcol("class") ne "E" ? v : NaN
estimated(k, v) = column("series") == k && strcol("kind") eq "published" && strcol("class") eq "E" ? v : NaN
array hollow[8] = [6, 4, 8, 12, 10, 6, 4, 8]
array full[8] = [7, 5, 9, 13, 11, 7, 5, 9]
turn(k) = (k - 1) % size + 1

set logscale xy
set xrange [3:8e6]
set yrange [low:high]
set xtics ("0" 4, "64" 64, "1 Ki" 1024, "16 Ki" 16384, "256 Ki" 262144, "4 Mi" 4194304)
set format y "10^{%T}"
left = panels == 1 ? 0.085 : 0.06
gap = 0.02
width = (0.985 - left - gap*(panels - 1))/panels
do for [format in formats] {
    page_wide = int(panels == 1 ? 760 : panels < 4 ? 420*panels : 360*panels); page_high = 560
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1.2 enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set tmargin at screen 0.88; set bmargin at screen 0.14
    do for [p=1:panels] {
        set lmargin at screen left + (p - 1)*(width + gap); set rmargin at screen left + (p - 1)*(width + gap) + width
        if (p == 1) {
            set label 97 headline at screen 0.5,0.965 center noenhanced font large(format)
            set label 98 subline at screen 0.5,0.933 center noenhanced textcolor rgb grey
            set label 99 provenance at screen 0.99,0.012 right noenhanced font least(format) textcolor rgb grey
        } else { unset label 97; unset label 98; unset label 99 }
        if (p == 1) { set ylabel "one way [µs]"; set format y "10^{%T}" } else { unset ylabel; set format y "" }
        set xlabel "message [B]"
        set key at graph 0.03, graph 0.985 left top vertical maxrows 8 samplen 2.6 spacing 1.15 font tiny
        plot for [k=first(p):final(p)] data using "shown_bytes":(curve(k, column("us"))) with lines linewidth 1.8 \
                linecolor rgb colour[turn(k)], \
             for [k=first(p):final(p)] data using "shown_bytes":(read_again(k, column("us"))) with points \
                pointtype full[turn(k)] pointsize 1.1 linecolor rgb colour[turn(k)], \
             for [k=first(p):final(p)] data using "shown_bytes":(estimated(k, column("us"))) with points \
                pointtype hollow[turn(k)] pointsize 1.1 linewidth 1.5 linecolor rgb colour[turn(k)], \
             for [k=first(p):final(p)] keyentry with linespoints linewidth 1.8 pointtype full[turn(k)] pointsize 1 \
                linecolor rgb colour[turn(k)] title machine[k]
    }
    unset multiplot
    unset output
}
