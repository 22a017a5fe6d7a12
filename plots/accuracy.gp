# accuracy.gp - error against run time: one row a ladder; left the host's time, right the predicted machine's.
data = figure.".csv"
stats data using "panel" nooutput
panels = int(STATS_max)
stats data using "series" nooutput
most = int(STATS_max)
array ladder[panels]; array quantity[panels]; array method[panels*most]; array failed[panels]; array least[panels]; array top[panels]
do for [i=1:panels] { failed[i] = ""; least[i] = 1; top[i] = 1e-300 }
do for [i=1:panels*most] { method[i] = "" }
stats data using (p = int(column("panel")), ladder[p] = strcol("ladder"), \
    quantity[p] = strcol("quantity")." against ".strcol("reference").", ".strcol("at"), \
    method[(p - 1)*most + int(column("series"))] = strcol("method"), \
    failed[p] = strcol("failed"), \
    e = column("relative_error"), least[p] = e > 0 && e < least[p] ? e : least[p], top[p] = e > top[p] ? e : top[p], \
    headline = "Error against run time, scenario ".strcol("scenario"), 0) nooutput
subline = "each point a rung, each curve a method"
of(p, k, v) = column("panel") == p && column("series") == k ? v : NaN
costs = "host_s machine_s"
array cost_name[2] = ["host time [s]", "predicted machine time [s]"]

set format x "10^{%T}"; set format y "10^{%T}"
do for [format in formats] {
    row = 330
    high = 70 + row*panels
    eval page(format, 800, high); tiny = small(format)
    set multiplot
    eval title_at(format, 1.0 - 18.0/high); eval foot(format)
    do for [p=1:panels] {
        # an exact answer is drawn two decades below the smallest error
        floor_error = 10**(floor(log10(least[p])) - 1)
        shown(v) = v < floor_error ? floor_error : v
        do for [side=1:2] {
            set lmargin at screen (side == 1 ? 0.10 : 0.44); set rmargin at screen (side == 1 ? 0.40 : 0.74)
            set tmargin at screen 1.0 - (60.0 + row*(p - 1) + 30)/high
            set bmargin at screen 1.0 - (60.0 + row*p - 60)/high
            set logscale xy
            set xrange [*:*] noextend; set offsets graph 0.06, graph 0.06, 0, 0; set yrange [floor_error/2:top[p]*3 > 1e-2 ? (top[p]*3) : 1e-2]
            set xlabel cost_name[side]
            set ylabel (side == 1 ? "relative error" : "")
            set format y (side == 1 ? "10^{%T}" : "")
            if (side == 1) {
                set label 1 ladder[p].": ".quantity[p] at graph 0,1.08 left noenhanced
                set label 2 (failed[p] eq "" ? "" : "failed (rungs): ".failed[p]) at screen 0.10,(1.0 - (60.0 + row*p - 8)/high) left noenhanced font tiny textcolor rgb "#d55e00"
                unset key
            } else {
                unset label 1; unset label 2
                set key at screen 0.755,(1.0 - (60.0 + row*(p - 1) + 30)/high) left top vertical maxrows 21 samplen 2.5 font tiny
            }
            plot for [k=1:most] data using (column(word(costs, side))):(of(p, k, shown(column("shown_error")))) \
                with linespoints linewidth 1.8 dashtype dash[(k - 1) % 8 + 1] pointtype point[(k - 1) % 8 + 1] pointsize 0.9 \
                linecolor rgb colour[(k - 1) % 8 + 1] title method[(p - 1)*most + k]
            unset label 97; unset label 98; unset label 99
        }
    }
    unset multiplot
    unset output
}
