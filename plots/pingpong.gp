# pingpong.gp - one-way message time against size: a curve a machine, published points as symbols of the same colour.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
array machine[last]
published = 0
stats data using (machine[int(column("series"))] = strcol("machine"), \
    published = published + (strcol("kind") eq "published"), 0) nooutput
headline = "Ping-pong on every machine: one-way time of a message"
subline = sprintf("curves: simulated; symbols: %d published points (hollow: class E, estimated)", published)
curve(k, v) = column("series") == k && strcol("kind") eq "simulated" ? v : NaN
read_again(k, v) = column("series") == k && strcol("kind") eq "published" && strcol("class") ne "E" ? v : NaN
estimated(k, v) = column("series") == k && strcol("kind") eq "published" && strcol("class") eq "E" ? v : NaN
array hollow[8] = [6, 4, 8, 12, 10, 6, 4, 8]
array full[8] = [7, 5, 9, 13, 11, 7, 5, 9]
tint(k) = colour[(k - 1) % 8 + 1]
turn(k) = int((k - 1)/8)
pattern(k) = turn(k) == 0 ? 1 : turn(k) == 1 ? 2 : 4
mark(k) = (k - 1 + 3*turn(k)) % 5 + 1

set logscale xy
set xrange [3:8e6]
set xtics ("0" 4, "16" 16, "64" 64, "256" 256, "1 Ki" 1024, "4 Ki" 4096, "16 Ki" 16384, "64 Ki" 65536, "256 Ki" 262144, \
           "1 Mi" 1048576, "4 Mi" 4194304)
set format y "10^{%T}"
set xlabel "message [B]"
set ylabel "one way [µs]"
do for [format in formats] {
    eval page(format, 900, 640); tiny = small(format)
    set lmargin at screen 0.085; set rmargin at screen 0.77
    set tmargin at screen 0.90; set bmargin at screen 0.115
    eval title_at(format, 0.97); eval foot(format)
    set key at screen 0.785,0.90 left top vertical maxrows 40 samplen 3.4 font tiny
    plot for [k=1:last] data using "shown_bytes":(curve(k, column("us"))) with lines linewidth 1.6 dashtype pattern(k) \
            linecolor rgb tint(k), \
         for [k=1:last] data using "shown_bytes":(read_again(k, column("us"))) with points pointtype full[mark(k)] \
            pointsize 1.1 linecolor rgb tint(k), \
         for [k=1:last] data using "shown_bytes":(estimated(k, column("us"))) with points pointtype hollow[mark(k)] \
            pointsize 1.1 linecolor rgb tint(k), \
         for [k=1:last] keyentry with linespoints linewidth 1.6 dashtype pattern(k) pointtype full[mark(k)] pointsize 0.9 \
            linecolor rgb tint(k) title machine[k]
    unset output
}
