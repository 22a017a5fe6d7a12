# _compare.gp - sets of runs side by side: times against what varies, and below where the time goes, a bar for each run.
data = figure.".csv"; about = figure.".about.csv"
xlabel = ""; errors = ""
stats about using (headline = strcol("title"), errors = strcol("errors"), sides = int(column("sides")), shown = int(column("shown")), \
    points = int(column("points")), lines = int(column("lines")), xlabel = strcol("xlabel"), xlog = int(column("xlog")), 0) nooutput
array name[sides]; longest = 0; longest_point = 0
stats data using (name[int(column("side"))] = strcol("name"), \
    longest = strlen(strcol("name")) > longest ? strlen(strcol("name")) : longest, \
    longest_point = strlen(strcol("point")) > longest_point ? strlen(strcol("point")) : longest_point, 0) nooutput
stats data using (column("makespan_s") + column("half_s")) nooutput
most = STATS_max; least = STATS_min
scale = most >= 1 ? 1.0 : (most >= 1e-3 ? 1e3 : 1e6)
unit = most >= 1 ? "s" : (most >= 1e-3 ? "ms" : "µs")
# runs of very different length: each bar is then a share of its own time
shares = most > 30*least
headline = "Comparison of ".headline
provenance = errors eq "" ? provenance : errors."; ".provenance
subline = shown < points ? sprintf("%d of the %d points in common", shown, points) : (points == 1 ? "" : sprintf("%d points in common", points))
wide = 900.0
bar_high = 17.0; group_high = bar_high*sides + 24
lines_high = lines ? 330.0 : 0
bars_high = shown*group_high + 60
upper = 60.0
high = upper + lines_high + 34 + bars_high + 30 + foot_more(provenance, wide)
at_y(px) = 1.0 - px/high
left = 0.03 + 0.0078*(longest > 44 ? 44 : longest)
left = left < 0.1 ? 0.1 : left
bar(v) = column("bar") > 0 ? v : NaN
y_of(p, s) = p + (s - 0.5*(sides + 1))*bar_high/group_high + 7/group_high
thick = 0.40*bar_high/group_high
part(v) = shares ? v/column("makespan_s")*100 : v*scale
array fill[4] = [compute_colour, send_colour, wait_colour, contention_colour]
array part_name[4] = ["computing", "sending, receiving", "waiting", "contention"]
from(k) = part((k > 1 ? column("compute_s") : 0) + (k > 2 ? column("overhead_s") : 0) + (k > 3 ? column("wait_s") : 0))
upto(k) = from(k) + part(k == 1 ? column("compute_s") : (k == 2 ? column("overhead_s") : (k == 3 ? column("wait_s") : column("contention_s"))))

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size int(2*wide),int(2*high) font png_font linewidth 2 enhanced } \
    else { set terminal svg size int(wide),int(high) font svg_font linewidth 1.2 enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set label 96 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 97 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, wide) at screen 0.99,at_y(high - foot_high(provenance, wide)) right noenhanced font least(format) textcolor rgb grey
    if (lines) {
        set lmargin at screen 0.1; set rmargin at screen 0.975
        set tmargin at screen at_y(upper + 8); set bmargin at screen at_y(upper + lines_high - 56)
        if (xlog) { set logscale x 2 } else { unset logscale x }
        if (shares) { set logscale y 10; set yrange [*:*] } else { set yrange [0:*] }
        set xrange [*:*]
        set format x "%.6g"; set format y "%.6g"
        set xtics nomirror out scale 0.6 autofreq offset 0,tick_lift(format); set ytics nomirror out scale 0.6 autofreq
        set xlabel xlabel noenhanced offset 0,name_lift(format); set ylabel "run time [".unit."]"
        set key top left noenhanced
        plot for [s=1:sides] data using (column("side") == s ? column("x") : NaN):(column("makespan_s")*scale):(column("half_s")*scale) \
                with yerrorbars linewidth 1 pointsize 0 linecolor rgb colour[s] notitle, \
             for [s=1:sides] data using (column("side") == s ? column("x") : NaN):(column("makespan_s")*scale) with linespoints \
                linewidth 1.8 dashtype dash[s] pointtype point[s] pointsize 0.9 linecolor rgb colour[s] title name[s]
        unset label 96; unset label 97; unset label 99; unset logscale
    }
    set lmargin at screen left; set rmargin at screen 0.975
    set tmargin at screen at_y(upper + lines_high + 34); set bmargin at screen at_y(upper + lines_high + 34 + bars_high - 54)
    set xrange [0:(shares ? 128 : most*scale*1.28)]; set yrange [shown + 0.6:0.4]
    set xlabel (shares ? "share of the time [%]" : "time, mean over the ranks [".unit."]") offset 0,name_lift(format); unset ylabel
    if (shares) { set xtics nomirror out scale 0.6 0,20,100 offset 0,tick_lift(format) } \
    else { set xtics nomirror out scale 0.6 autofreq offset 0,tick_lift(format) }
    unset ytics
    set key at screen 0.5,at_y(upper + lines_high + 6) center top horizontal maxcols 4 samplen 1.2 width -1
    plot for [k=1:4] data using (bar(from(k))):(y_of(column("place"), column("side"))):(from(k)):(upto(k)):(y_of(column("place"), column("side")) - thick):(y_of(column("place"), column("side")) + thick) \
            with boxxyerror fillcolor rgb fill[k] linewidth 0.4 notitle, \
         for [k=1:4] keyentry with boxes fillcolor rgb fill[k] title part_name[k], \
         data using (bar(part(column("makespan_s")))):(y_of(column("place"), column("side"))):(sprintf("%.4g %s", column("makespan_s")*scale, unit).(column("side") > 1 ? sprintf("  (%.3g×)", column("ratio")) : "")) \
            with labels left offset 0.6,0 noenhanced font tiny notitle, \
         data using (bar(0)):(y_of(column("place"), column("side"))):(strcol("name")) with labels right offset -0.6,0 noenhanced font tiny notitle, \
         data using (column("bar") > 0 && column("side") == 1 ? 0 : NaN):(column("place") - 0.5 + 11/group_high):(strcol("point")) \
            with labels left offset 0.6,0 noenhanced font tiny textcolor rgb grey notitle
    unset multiplot
    unset output
}
