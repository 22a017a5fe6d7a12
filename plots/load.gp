# load.gp - latency (mean with its interval, 99 % dashed) and accepted load against offered load; a vertical line in the
# left panel is the load of saturation, with its uncertainty as a bar at the foot.
data = figure.".csv"
stats data using "curve" nooutput
last = int(STATS_max)
array name[last]; array sat[last]; array low[last]; array high[last]
do for [k=1:last] { sat[k] = -1; low[k] = -1; high[k] = -1 }
lowest = 1e300; highest = 0; machine = ""
number(s) = strcol(s) eq "" ? NaN : column(s)
stats data using (k = int(column("curve")), name[k] = strcol("name"), sat[k] = strcol("saturation") eq "" ? -1 : column("saturation"), \
    low[k] = strcol("low") eq "" ? -1 : column("low"), high[k] = strcol("high") eq "" ? -1 : column("high"), \
    lowest = column("empty_ns") < lowest ? column("empty_ns") : lowest, highest = column("empty_ns") > highest ? column("empty_ns") : highest, \
    headline = "Latency and accepted load: ".strcol("traffic")." traffic", 0) nooutput
subline = "lines: mean, with its 95 % confidence interval;  dashed: 99th percentile;  vertical: saturation (three times the empty network)"
of(k, v) = column("curve") == k ? v : NaN
# of an interval that a logarithmic axis cannot hold, the part that it can
from(v) = v > lowest*0.7 ? v : lowest*0.7
# two columns of titles where both have room
longest = 0
do for [k=1:last] { longest = (n = strlen(name[k]) + (sat[k] > 0 ? 38 : 0), n > longest ? n : longest) }
rows = longest > 52 ? last : (last + 1)/2

do for [format in formats] {
    high_px = 512.0 + 20*rows
    page_wide = 1000; page_high = int(high_px)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format
    set multiplot
    set label 97 headline at screen 0.5,(1.0 - 20/high_px) center noenhanced font large(format)
    set label 98 subline at screen 0.5,(1.0 - 44/high_px) center noenhanced textcolor rgb grey font small(format)
    set label 99 foot(provenance, page_wide) at screen 0.99,(9/high_px + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set tmargin at screen 1.0 - 68.0/high_px; set bmargin at screen (84.0 + 20*rows)/high_px
    set xtics autofreq offset 0,tick_lift(format)
    set xrange [0:*]
    # latency
    set lmargin at screen 0.1; set rmargin at screen 0.52
    set logscale y; set yrange [lowest*0.7:highest*12]
    # a range of one or two decades has few powers of ten
    set ytics ()
    do for [d=floor(log10(lowest*0.7)):ceil(log10(highest*12))] { do for [m in "1 2 5"] { set ytics add (sprintf("%g", m*10.0**d) m*10.0**d) } }
    set xlabel "offered load [flits per node and cycle]" offset 0,name_lift(format); set ylabel "latency [ns]"
    set key at screen 0.1,((20.0*rows + 30)/high_px) left top vertical maxrows rows samplen 2.4 noenhanced
    do for [k=1:last] { if (sat[k] > 0) {
        set arrow 10+k from sat[k],lowest*0.7 to sat[k],highest*12 nohead linewidth 1 dashtype 3 linecolor rgb colour[turn(k)]
        set arrow 30+k from low[k],lowest*0.74 to high[k],lowest*0.74 nohead linewidth 4 linecolor rgb colour[turn(k)]
    } }
    plot for [k=1:last] data using "offered":(of(k, number("p99_ns"))) with lines linewidth 1 dashtype 2 linecolor rgb colour[turn(k)], \
         for [k=1:last] data using "offered":(of(k, number("mean_ns"))):(from(number("mean_ns") - number("half_ns"))): \
            (number("mean_ns") + number("half_ns")) with yerrorbars linewidth 1.2 pointtype 0 linecolor rgb colour[turn(k)], \
         for [k=1:last] data using "offered":(of(k, number("mean_ns"))) with lines linewidth 1.6 linecolor rgb colour[turn(k)], \
         for [k=1:last] data using "offered":(near(of(k, number("mean_ns")))):(sprintf("load %.4g: mean %.5g ns, 99 %% below %.5g ns", \
            column("offered"), number("mean_ns"), number("p99_ns"))) with labels hypertext point pointtype point[turn(k)] pointsize 0.6 \
            linecolor rgb colour[turn(k)], \
         for [k=1:last] keyentry with linespoints linewidth 1.6 pointtype point[turn(k)] pointsize 0.7 linecolor rgb colour[turn(k)] \
            title name[k].(sat[k] > 0 ? sprintf("  (saturates at %.3f, %.3f to %.3f)", sat[k], low[k], high[k]) : "")
    unset label 97; unset label 98; unset label 99; unset key
    do for [k=1:last] { unset arrow 10+k; unset arrow 30+k }
    # accepted
    unset logscale
    set ytics autofreq
    set lmargin at screen 0.61; set rmargin at screen 0.98
    set yrange [0:*]
    set ylabel "accepted load [flits per node and cycle]"
    plot data using "offered":"offered" with lines linewidth 1 dashtype 2 linecolor rgb pale, \
         for [k=1:last] data using "offered":(of(k, number("accepted"))) with linespoints linewidth 1.6 pointtype point[turn(k)] \
            pointsize 0.6 linecolor rgb colour[turn(k)]
    unset multiplot
    unset output
    set ytics autofreq
}
