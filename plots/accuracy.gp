# accuracy.gp - error against run time of one ladder: a column for each family of methods, above against the host's time and
# below against the predicted machine's. An exact answer stands on a line of its own, never at a decade.
data = figure.".csv"
refused = figure.".failed.csv"
array ladder_name[3] = ["network", "arithmetic", "integration"]
array family[9] = ["", "", "", "serial methods", "paper formulation, by solver", "direct formulation, by solver", \
    "explicit steppers", "implicit steppers", "own parallel steppers"]
array notes[3] = ["the same program on every level; a level's answer against that of the finest", \
    "○ plain;  □ solver refined;  △ all refined;  ◇ and forces in twice the digits;  open: float;  filled: double;  *: quad (no machine time);  ×: error above 0.1", \
    "filled, solid: by tolerance;  open, dotted: by fixed steps;  machine time: on the number of processors that evaluates fastest"]
# by refinement
array open_shape[4] = [6, 4, 8, 12]

b = 0; header = ""; allowed = ""; least = 1.0; top = 1e-300
array most[3] = [0, 0, 0]; array low[2] = [1e300, 1e300]; array high[2] = [0, 0]; array curve_name[60]
do for [i=1:60] { curve_name[i] = "" }
stats data using (b = int(column("block")), c = int(column("panel")), k = int(column("series")), \
    header = strcol("quantity")." against ".strcol("reference").", ".strcol("at"), allowed = strcol("allowed"), \
    curve_name[20*c - 20 + k] = strcol("name"), most[c] = k > most[c] ? k : most[c], \
    e = column("relative_error"), least = e > 0 && e < least ? e : least, top = e > top ? e : top, \
    h = column("host_s"), h = e >= 0 && h > 0 ? h : NaN, low[1] = h < low[1] ? h : low[1], high[1] = h > high[1] ? h : high[1], \
    h = column("machine_s"), h = e >= 0 && h > 0 ? h : NaN, low[2] = h < low[2] ? h : low[2], high[2] = h > high[2] ? h : high[2], \
    headline = "Error against run time: ".strcol("scenario").", ", 0) nooutput
headline = headline.ladder_name[b]
# no error at all: the rungs are exact, or none answered
if (!(least <= top)) { least = 1e-16; top = 1.0 }
failures = 0
stats refused using (column("line") > 0 ? (failures = failures + 1, 0) : 0) nooutput
subline = header.(allowed eq "" ? "" : ";  ").(allowed eq "" ? "" : "ring: the cheapest ".(b == 1 ? "on this computer" : "on the machine")." within ".allowed).(failures > 0 ? ";  some rungs failed: see the report" : "")

# The network has two panels and a table; the others two rows of panels with the names of their curves below.
panels = b == 1 ? 2 : 3
sides = b == 1 ? 1 : 2
longest = most[1] > most[2] ? (most[1] > most[3] ? most[1] : most[3]) : (most[2] > most[3] ? most[2] : most[3])
wide = 1000.0; left_edge = 80.0; gap = 20.0; panel_wide = (wide - left_edge - 14 - 2*gap)/3; panel_high = b == 1 ? 190.0 : 200.0
upper_edge = 106.0
row_high = panel_high + 62
total = upper_edge + sides*row_high + (b == 1 ? 0 : 16*longest) + 30
at_x(px) = px/wide; at_y(px) = 1.0 - px/total
column_left(c) = left_edge + (c - 1)*(panel_wide + gap)
decade(x) = floor(log10(x))
here(c) = column("panel") == c && column("drawn") == 1
# an empty cell is asked for as a text first: gnuplot 5.4 breaks down over labels all of which are missing
given(name) = strcol(name) eq "" ? NaN : column(name)
good(c, k) = strcol("relative_error") ne "" && here(c) && column("series") == k && column("relative_error") >= 0 && strcol("status") ne "failed"
poor(c, k) = strcol("relative_error") ne "" && here(c) && column("series") == k && column("relative_error") >= 0 && strcol("status") eq "failed"
number(x) = x == 0 ? "exact" : x > 0 ? gprintf("%.1te%T", x) : "–"
seconds(x) = x < 1e-3 ? sprintf("%.3g µs", x*1e6) : x < 1 ? sprintf("%.3g ms", x*1e3) : sprintf("%.3g s", x)
exactly(x) = x < 1e-3 ? sprintf("%.4g µs", x*1e6) : x < 1 ? sprintf("%.4g ms", x*1e3) : sprintf("%.4g s", x)
bottom = decade(least) - (decade(top) - decade(least) > 6 ? 1.5 : 0.7)
exact = 10**bottom; over = 10**(decade(top) + 1)
level(x) = x == 0 ? exact : x
step = ceil((decade(over) - decade(least))/7.0)
told(cost) = sprintf("error %s, %s", number(given("relative_error")), seconds(given(cost)))

do for [format in formats] {
    page_wide = int(wide); page_high = int(total)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set label 97 headline at screen 0.5,at_y(18) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 96 notes[b] at screen at_x(14),at_y(66) left noenhanced font tiny textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,at_y(total - 9 - foot_lift(provenance, page_wide)) right noenhanced font least(format) textcolor rgb grey
    do for [side=1:sides] { do for [c=1:panels] { if (b == 1 || most[c] > 0) {
        across = b == 1 ? c : side
        cost = across == 1 ? "host_s" : "machine_s"
        x0 = low[across]; x1 = high[across]
        if (x1 == 0) { x0 = 1e-6; x1 = 1 }
        from = upper_edge + (side - 1)*row_high
        set lmargin at screen at_x(column_left(c)); set rmargin at screen at_x(column_left(c) + panel_wide)
        set tmargin at screen at_y(from); set bmargin at screen at_y(from + panel_high)
        set logscale y; set yrange [10**(bottom - 0.35):over]
        set ytics 10**(decade(over) - step*floor((decade(over) - decade(least))/step)),10**step,over; set ytics add ("exact" exact)
        set format y (c == 1 ? "10^{%T}" : "")
        if (c > 1) { set ytics add ("" exact) }
        set ylabel (c == 1 ? "relative error" : "") offset 1,0
        if (b == 1 && c == 2) {
            unset logscale x
            pad = x1 > x0 ? 0.12*(x1 - x0) : 0.1*x0
            unit = x1 < 1e-3 ? 1e6 : x1 < 1 ? 1e3 : 1.0
            raw = unit*(x1 - x0 + 2*pad)/4; ten = 10**floor(log10(raw))
            set xrange [unit*(x0 - pad):unit*(x1 + pad)]
            set xtics autofreq ten*(raw/ten < 1.5 ? 1 : raw/ten < 3.5 ? 2 : raw/ten < 7.5 ? 5 : 10) offset 0,tick_lift(format); set format x "%g"
            set xlabel "predicted makespan [".(unit == 1e6 ? "µs" : unit == 1e3 ? "ms" : "s")."]" offset 0,name_lift(format)
        } else {
            unit = 1.0
            x0 = x0/1.5; x1 = x1*1.5
            if (decade(x1) - decade(x0) < 2) { x0 = 0.8*10**decade(x0); x1 = 1.25*10**(decade(x1) + 1) }
            set logscale x; set xrange [x0:x1]; set xtics autofreq offset 0,tick_lift(format); set format x "10^{%T}"
            set xlabel (across == 1 ? "host time [s]" : "predicted machine time [s]") offset 0,name_lift(format)
        }
        if (side == 1 && b > 1) { set label 3 family[3*b-3+c] at graph 0,1.05 left noenhanced font tiny } else { unset label 3 }
        set arrow 1 from graph 0,first exact to graph 1,first exact nohead linewidth 1 dashtype 2 linecolor rgb pale
        unset key
        if (b > 1 && side == 2) { set key at screen at_x(column_left(c) - 10),at_y(from + row_high - 12) left top vertical maxrows longest samplen 2.4 width 1 font tiny }
        n = b == 1 ? most[1] : most[c]
        if (b == 1) {
            plot for [k=1:n] data using (good(1, k) ? unit*given(cost) : away):(near(level(given("relative_error")))):(told(cost)) with labels hypertext point \
                pointtype hollow[turn(k)] pointsize 1 linewidth 1.8 linecolor rgb colour[turn(k)], \
            data using (column("chosen") == 1 ? unit*given(cost) : NaN):(level(given("relative_error"))) \
                with points pointtype 6 pointsize 1.9 linewidth 1.6 linecolor rgb "#000000"
        }
        if (b == 2) {
            plot for [k=1:n] for [q=1:3] data using (good(c, k) && column("precision") == q ? given(cost) : NaN):(level(given("relative_error"))) \
                    with lines linewidth 1 dashtype 1+2*(q == 1) linecolor rgb colour[turn(k)], \
                for [k=1:n] for [r=0:3] for [q=1:2] data using (good(c, k) && column("precision") == q && column("refinement") == r ? given(cost) : away) \
                    :(near(level(given("relative_error")))):(told(cost)) with labels hypertext point pointtype open_shape[r+1] + q - 1 pointsize 0.75 \
                    linewidth 1.5 linecolor rgb colour[turn(k)], \
                for [k=1:n] data using (good(c, k) && column("precision") == 3 ? given(cost) : away):(near(level(given("relative_error")))):(told(cost)) \
                    with labels hypertext point pointtype 3 pointsize 0.8 linewidth 1.5 linecolor rgb colour[turn(k)], \
                for [k=1:n] data using (poor(c, k) ? given(cost) : NaN):(level(given("relative_error"))) \
                    with points pointtype 2 pointsize 0.8 linewidth 1.6 linecolor rgb colour[turn(k)], \
                data using (column("panel") == c && column("chosen") == 1 ? unit*given(cost) : NaN):(level(given("relative_error"))) \
                    with points pointtype 6 pointsize 1.7 linewidth 1.6 linecolor rgb "#000000", \
                for [k=1:n] NaN with lines linewidth 3 linecolor rgb colour[turn(k)] title curve_name[20*c - 20 + k]
        }
        if (b == 3) {
            plot for [k=1:n] for [r=0:1] data using (good(c, k) && column("refinement") == r ? given(cost) : NaN):(level(given("relative_error"))) \
                    with lines linewidth (r == 0 ? 1.5 : 1.2) dashtype 1+2*r linecolor rgb colour[turn(k)], \
                for [k=1:n] for [r=0:1] data using (good(c, k) && column("refinement") == r ? given(cost) : away):(near(level(given("relative_error")))) \
                    :(told(cost)) with labels hypertext point pointtype (r == 0 ? point[turn(k)] : hollow[turn(k)]) pointsize 0.65 linewidth 1.2 \
                    linecolor rgb colour[turn(k)], \
                for [k=1:n] data using (poor(c, k) ? given(cost) : NaN):(level(given("relative_error"))) \
                    with points pointtype 2 pointsize 0.8 linewidth 1.6 linecolor rgb colour[turn(k)], \
                data using (column("panel") == c && column("chosen") == 1 ? unit*given(cost) : NaN):(level(given("relative_error"))) \
                    with points pointtype 6 pointsize 1.7 linewidth 1.6 linecolor rgb "#000000", \
                for [k=1:n] NaN with linespoints linewidth 1.5 pointtype point[turn(k)] pointsize 0.7 linecolor rgb colour[turn(k)] \
                    title curve_name[20*c - 20 + k]
        }
        unset label 3; unset label 96; unset label 97; unset label 98; unset label 99; unset arrow 1
    }}}
    if (b == 1) { # the numbers themselves: where levels agree their symbols lie on each other
        set lmargin at screen at_x(column_left(3)); set rmargin at screen at_x(column_left(3) + panel_wide)
        unset border; unset xtics; unset ytics; unset xlabel; unset ylabel; unset grid; unset logscale; unset key
        set xrange [0:1.03]; set yrange [-most[1]-0.7:0.7]
        set label 1 "level" at 0.09,0 font tiny textcolor rgb grey; set label 2 "error" at 0.52,0 right font tiny textcolor rgb grey
        set label 3 "host" at 0.77,0 right font tiny textcolor rgb grey; set label 4 "predicted" at 1.03,0 right font tiny textcolor rgb grey
        plot for [k=1:most[1]] data using (good(1, k) ? 0.03 : NaN):(-k) with points pointtype hollow[turn(k)] \
                pointsize 1 linewidth 1.8 linecolor rgb colour[turn(k)], \
            data using (0.09):(here(1) ? -column("series") : NaN):(strcol("name")) with labels left noenhanced font tiny, \
            data using (0.52):(here(1) ? -column("series") : NaN):(number(column("relative_error"))) with labels right noenhanced font tiny, \
            data using (0.77):(here(1) ? -column("series") : NaN):(column("host_s") > 0 ? seconds(column("host_s")) : "–") with labels right noenhanced font tiny, \
            data using (1.03):(here(1) ? -column("series") : NaN):(column("machine_s") > 0 ? exactly(column("machine_s")) : "–") with labels right noenhanced font tiny
        do for [i=1:4] { unset label i }
        set border 3 linewidth 0.8; set xtics nomirror out scale 0.6; set ytics nomirror out scale 0.6
        set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
    }
    unset multiplot
    unset output
}
