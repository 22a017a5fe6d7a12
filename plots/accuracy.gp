# accuracy.gp - error against run time: a block for each ladder, a column for each family of methods, above against the
# host's time and below against the predicted machine's. An exact answer stands on a line of its own, never at a decade.
data = figure.".csv"
refused = figure.".failed.csv"
array ladder_name[3] = ["Network", "Arithmetic", "Integration"]
array family[9] = ["", "", "", "serial methods", "paper formulation, by solver", "direct formulation, by solver", \
    "explicit steppers", "implicit steppers", "own parallel steppers"]
array notes[3] = ["the same program on every level; a level's answer against that of the finest", \
    "○ float   □ double   △ quad (no machine time);   open: plain,  with +: solver refined,  filled: whole solve refined,  filled with +: and forces in twice the digits;   ×: error above 0.1", \
    "the motion's end against a tight reference; ●, solid: by tolerance;  ○, dashed: by fixed steps;  machine time on the number of processors that is fastest for one evaluation"]
array open_point[6] = [6, 4, 8, 10, 12, 3]
array full_point[6] = [7, 5, 9, 11, 13, 15]
array by_precision[3] = [6, 4, 8]

array header[3]; array allowed[3]; array rows[3]; array most[9]; array least[3]; array top[3]; array used[9]
array low[6]; array high[6]; array curve_name[90]
do for [i=1:3] { header[i] = ""; allowed[i] = ""; rows[i] = 0; least[i] = 1; top[i] = 1e-300 }
do for [i=1:6] { low[i] = 1e300; high[i] = 0 }
do for [i=1:9] { most[i] = 0; used[i] = 0 }
do for [i=1:90] { curve_name[i] = "" }
stats data using (b = int(column("block")), c = 3*b - 3 + int(column("panel")), k = int(column("series")), \
    header[b] = ladder_name[b].": ".strcol("quantity")." against ".strcol("reference").", ".strcol("at"), \
    allowed[b] = strcol("allowed"), curve_name[10*c - 10 + k] = strcol("name"), used[c] = 1, most[c] = k > most[c] ? k : most[c], \
    e = column("relative_error"), least[b] = e > 0 && e < least[b] ? e : least[b], top[b] = e > top[b] ? e : top[b], \
    h = column("host_s"), h = e >= 0 && h > 0 ? h : NaN, low[2*b-1] = h < low[2*b-1] ? h : low[2*b-1], \
    high[2*b-1] = h > high[2*b-1] ? h : high[2*b-1], \
    h = column("machine_s"), h = e >= 0 && h > 0 ? h : NaN, low[2*b] = h < low[2*b] ? h : low[2*b], \
    high[2*b] = h > high[2*b] ? h : high[2*b], \
    headline = "Error against run time: ".strcol("scenario"), 0) nooutput
# A block without any error: all its rungs are exact, or none answered.
do for [b=1:3] { if (!(least[b] <= top[b])) { least[b] = 1e-16; top[b] = 1.0 } }
subline = "each symbol a rung of a ladder, each curve a method; further left is cheaper, further down is better"
# Lines below a block's panels that tell what failed.
array failures[3]; do for [i=1:3] { failures[i] = 0 }
stats refused using (b = int(column("block")), n = int(column("line")), b > 0 ? (failures[b] = n > failures[b] ? n : failures[b]) : 0, 0) nooutput

wide = 1150.0; left_edge = 82.0; gap = 16.0; panel_wide = (wide - left_edge - 14 - 2*gap)/3; panel_high = 168.0
longest(b) = most[3*b-2] > most[3*b-1] ? (most[3*b-2] > most[3*b] ? most[3*b-2] : most[3*b]) : \
    (most[3*b-1] > most[3*b] ? most[3*b-1] : most[3*b])
key_rows(b) = b == 1 ? 0 : b == 2 ? longest(b) : ceil(longest(b)/2.0)
panels_high(b) = 60 + (b == 1 ? panel_high + 46 : 2*panel_high + 96)
block_high(b) = header[b] eq "" ? 0 : panels_high(b) + 16*key_rows(b) + (failures[b] > 0 ? 16 + 15*failures[b] : 4) + 20
begins(b) = 66 + (b > 1 ? block_high(1) : 0) + (b > 2 ? block_high(2) : 0)
total = begins(3) + block_high(3) + 24
at_x(px) = px/wide; at_y(px) = 1.0 - px/total
column_left(c) = left_edge + (c - 1)*(panel_wide + gap)
decade(x) = floor(log10(x))
here(b, c) = column("block") == b && column("panel") == c && column("drawn") == 1
good(b, c, k) = here(b, c) && column("series") == k && column("relative_error") >= 0 && strcol("status") ne "failed"
poor(b, c, k) = here(b, c) && column("series") == k && column("relative_error") >= 0 && strcol("status") eq "failed"
cell(b, c, s) = strcol("block") eq sprintf("%d", b) && strcol("panel") eq sprintf("%d", c) ? s : ""
number(x) = x == 0 ? "exact" : x > 0 ? gprintf("%.1te%T", x) : "–"
seconds(x) = x < 1e-3 ? sprintf("%.3g µs", x*1e6) : x < 1 ? sprintf("%.3g ms", x*1e3) : sprintf("%.3g s", x)
exactly(x) = x < 1e-3 ? sprintf("%.4g µs", x*1e6) : x < 1 ? sprintf("%.4g ms", x*1e3) : sprintf("%.4g s", x)
short(s, n) = strlen(s) > n ? s[1:n-1]."…" : s

do for [format in formats] {
    page_wide = int(wide); page_high = int(total)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = format eq "png" ? ",16" : ",11"; strong = format eq "png" ? ",20" : ",13.5"
    # svg draws symbols larger and sets labels of axes lower
    symbol = format eq "png" ? 1.0 : 0.55; lift = format eq "png" ? 0.4 : 0.75
    set multiplot
    set label 97 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 99 provenance at screen 0.99,0.012 right noenhanced font least(format) textcolor rgb grey
    do for [b=1:3] { if (header[b] ne "") {
        bottom = decade(least[b]) - (decade(top[b]) - decade(least[b]) > 6 ? 1.5 : 0.7)
        exact = 10**bottom; over = 10**(decade(top[b]) + 1)
        level(x) = x == 0 ? exact : x
        step = ceil((decade(over) - decade(least[b]))/7.0)
        set label 1 header[b].(allowed[b] eq "" ? "" : ";  ring: the cheapest ".(b == 1 ? "on this computer" : "on the machine")." within ".allowed[b]) at screen at_x(14),at_y(begins(b) + 12) left noenhanced font strong
        set label 2 notes[b] at screen at_x(14),at_y(begins(b) + 31) left noenhanced font tiny textcolor rgb "#505050"
        do for [side=1:(b == 1 ? 1 : 2)] { do for [c=1:(b == 1 ? 2 : 3)] { if (b == 1 || used[3*b-3+c]) {
            across = b == 1 ? c : side
            cost = across == 1 ? "host_s" : "machine_s"
            x0 = low[2*b-2+across]; x1 = high[2*b-2+across]
            if (x1 == 0) { x0 = 1e-6; x1 = 1 }
            upper = begins(b) + 60 + (side - 1)*(panel_high + 48)
            set lmargin at screen at_x(column_left(c)); set rmargin at screen at_x(column_left(c) + panel_wide)
            set tmargin at screen at_y(upper); set bmargin at screen at_y(upper + panel_high)
            set logscale y; set yrange [10**(bottom - 0.35):over]
            set ytics 10**(decade(over) - step*floor((decade(over) - decade(least[b]))/step)),10**step,over; set ytics add ("exact" exact)
            set format y (c == 1 ? "10^{%T}" : "")
            if (c > 1) { set ytics add ("" exact) }
            set ylabel (c == 1 ? "relative error" : "") offset 1,0
            if (b == 1 && c == 2) {
                unset logscale x
                pad = x1 > x0 ? 0.12*(x1 - x0) : 0.1*x0
                unit = x1 < 1e-3 ? 1e6 : x1 < 1 ? 1e3 : 1.0
                raw = unit*(x1 - x0 + 2*pad)/4; ten = 10**floor(log10(raw))
                set xrange [unit*(x0 - pad):unit*(x1 + pad)]
                set xtics autofreq ten*(raw/ten < 1.5 ? 1 : raw/ten < 3.5 ? 2 : raw/ten < 7.5 ? 5 : 10); set format x "%g"
                set xlabel "predicted makespan [".(unit == 1e6 ? "µs" : unit == 1e3 ? "ms" : "s")."]" offset 0,lift
            } else {
                unit = 1.0
                x0 = x0/1.5; x1 = x1*1.5
                if (decade(x1) - decade(x0) < 2) { x0 = 0.8*10**decade(x0); x1 = 1.25*10**(decade(x1) + 1) }
                set logscale x; set xrange [x0:x1]; set xtics autofreq; set format x "10^{%T}"
                set xlabel (across == 1 ? "host time [s]" : "predicted machine time [s]") offset 0,lift
            }
            if (side == 1 && b > 1) { set label 3 family[3*b-3+c] at graph 0,1.06 left noenhanced font tiny } else { unset label 3 }
            set arrow 1 from graph 0,first exact to graph 1,first exact nohead linewidth 1 dashtype 2 linecolor rgb pale
            unset key
            if (b > 1 && side == 2) {
                set key at screen at_x(column_left(c) - 6),at_y(begins(b) + panels_high(b) + 2) left top vertical maxrows key_rows(b) \
                    samplen 2 width 1 font tiny
            }
            n = b == 1 ? most[1] : most[3*b-3+c]
            p = b == 1 ? 1 : c
            if (b == 1) {
                plot for [k=1:n] data using (good(1, 1, k) ? unit*column(cost) : NaN):(level(column("relative_error"))) with points \
                    pointtype open_point[(k-1)%6+1] pointsize 1.9*symbol linewidth 1.8 linecolor rgb colour[turn(k)], \
                    data using (column("block") == 1 && column("chosen") == 1 ? unit*column(cost) : NaN):(level(column("relative_error"))) \
                        with points pointtype 6 pointsize 3.2*symbol linewidth 1.6 linecolor rgb "#000000"
            }
            if (b == 2) {
                plot for [k=1:n] for [q=1:3] data using (good(b, p, k) && column("precision") == q ? column(cost) : NaN):(level(column("relative_error"))) \
                        with lines linewidth 1 linecolor rgb colour[turn(k)], \
                    for [k=1:n] for [q=1:3] data using (good(b, p, k) && column("precision") == q && column("refinement") < 2 ? column(cost) : NaN) \
                        :(level(column("relative_error"))) with points pointtype by_precision[q] pointsize 1.3*symbol linewidth 1.5 linecolor rgb colour[turn(k)], \
                    for [k=1:n] for [q=1:3] data using (good(b, p, k) && column("precision") == q && column("refinement") >= 2 ? column(cost) : NaN) \
                        :(level(column("relative_error"))) with points pointtype by_precision[q] + 1 pointsize 1.3*symbol linecolor rgb colour[turn(k)], \
                    for [k=1:n] data using (good(b, p, k) && column("refinement") == 3 ? column(cost) : NaN) \
                        :(level(column("relative_error"))) with points pointtype 1 pointsize 0.8*symbol linewidth 1.5 linecolor rgb "#ffffff", \
                    for [k=1:n] data using (good(b, p, k) && column("refinement") == 1 ? column(cost) : NaN) \
                        :(level(column("relative_error"))) with points pointtype 1 pointsize 0.8*symbol linewidth 1.5 linecolor rgb colour[turn(k)], \
                    for [k=1:n] data using (poor(b, p, k) ? column(cost) : NaN):(level(column("relative_error"))) \
                        with points pointtype 2 pointsize 1.2*symbol linewidth 1.6 linecolor rgb colour[turn(k)], \
                    data using (column("block") == b && column("panel") == p && column("chosen") == 1 ? unit*column(cost) : NaN):(level(column("relative_error"))) \
                        with points pointtype 6 pointsize 2.7*symbol linewidth 1.6 linecolor rgb "#000000", \
                    for [k=1:n] NaN with lines linewidth 3 linecolor rgb colour[turn(k)] title curve_name[10*(3*b-3+c) - 10 + k]
            }
            if (b == 3) {
                plot for [k=1:n] data using (good(b, p, k) && column("refinement") == 0 ? column(cost) : NaN):(level(column("relative_error"))) \
                        with linespoints linewidth 1.5 pointtype full_point[(k-1)%6+1] pointsize 1.1*symbol linecolor rgb colour[turn(k)], \
                    for [k=1:n] data using (good(b, p, k) && column("refinement") == 1 ? column(cost) : NaN):(level(column("relative_error"))) \
                        with linespoints linewidth 1.2 dashtype 3 pointtype full_point[(k-1)%6+1] - 1 pointsize 1.1*symbol linecolor rgb colour[turn(k)], \
                    for [k=1:n] data using (poor(b, p, k) ? column(cost) : NaN):(level(column("relative_error"))) \
                        with points pointtype 2 pointsize 1.2*symbol linewidth 1.6 linecolor rgb colour[turn(k)], \
                    data using (column("block") == b && column("panel") == p && column("chosen") == 1 ? unit*column(cost) : NaN):(level(column("relative_error"))) \
                        with points pointtype 6 pointsize 2.7*symbol linewidth 1.6 linecolor rgb "#000000", \
                    for [k=1:n] NaN with linespoints linewidth 1.5 pointtype full_point[(k-1)%6+1] pointsize 1.1*symbol linecolor rgb colour[turn(k)] \
                        title curve_name[10*(3*b-3+c) - 10 + k]
            }
            unset label 1; unset label 2; unset label 3; unset label 97; unset label 98; unset label 99; unset arrow 1
        }}}
        if (b == 1) { # the numbers themselves: where levels agree their symbols lie on each other
            set lmargin at screen at_x(column_left(3)); set rmargin at screen at_x(column_left(3) + panel_wide)
            unset border; unset xtics; unset ytics; unset xlabel; unset ylabel; unset grid; unset logscale; unset key
            set xrange [0:1.03]; set yrange [-most[1]-0.7:0.7]
            set label 1 "level" at 0.09,0 font tiny textcolor rgb "#505050"; set label 2 "error" at 0.52,0 right font tiny textcolor rgb "#505050"
            set label 3 "host" at 0.77,0 right font tiny textcolor rgb "#505050"; set label 4 "predicted" at 1.0,0 right font tiny textcolor rgb "#505050"
            plot for [k=1:most[1]] data using (good(1, 1, k) ? 0.03 : NaN):(-k) with points pointtype open_point[(k-1)%6+1] \
                    pointsize 1.9*symbol linewidth 1.8 linecolor rgb colour[turn(k)], \
                data using (0.09):(here(1, 1) ? -column("series") : NaN):(strcol("name")) with labels left noenhanced font tiny, \
                data using (0.52):(here(1, 1) ? -column("series") : NaN):(number(column("relative_error"))) with labels right noenhanced font tiny, \
                data using (0.77):(here(1, 1) ? -column("series") : NaN):(column("host_s") > 0 ? seconds(column("host_s")) : "–") with labels right noenhanced font tiny, \
                data using (1.0):(here(1, 1) ? -column("series") : NaN):(column("machine_s") > 0 ? exactly(column("machine_s")) : "–") with labels right noenhanced font tiny
            do for [i=1:4] { unset label i }
            set border 3 linewidth 0.8; set xtics nomirror out scale 0.6; set ytics nomirror out scale 0.6
            set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
        }
        if (failures[b] > 0) {
            lower = begins(b) + panels_high(b) + 16*key_rows(b) + 8
            set lmargin at screen 0; set rmargin at screen 1; set tmargin at screen 1; set bmargin at screen 0
            unset border; unset tics; unset xlabel; unset ylabel; unset grid; unset logscale; unset key
            set xrange [0:1]; set yrange [0:1]
            set label 1 "failed:" at screen at_x(14),at_y(lower + 8) left noenhanced font tiny textcolor rgb "#b0401a"
            plot refused using (column("block") == b ? at_x(column_left(b == 1 ? 1 : column("panel"))) : NaN):(at_y(lower + 15*column("line") - 7)) \
                :(short(strcol("text"), b == 1 ? 160 : 68)) \
                with labels left noenhanced font tiny textcolor rgb "#b0401a"
            unset label 1
            set border 3 linewidth 0.8; set xtics nomirror out scale 0.6; set ytics nomirror out scale 0.6
            set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
        }
    }}
    unset multiplot
    unset output
}
