# fig5.gp - mean time per stage, stacked by what it was spent on, at two sizes side by side.
data = figure.".csv"
stats data using "total_us" nooutput
top = STATS_max*1.12
stats data using "stage" nooutput
last = STATS_max
stats data using (headline = "Time per stage on ".strcol("machine"), \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators, network level ".strcol("level"), 0) nooutput
sizes = "16 128"
# A part too thin to be seen is given in words, and not in the legend.
contended = 0; longest = 1e-9
stats data using (contended = column("contention_us") > contended ? column("contention_us") : contended, \
    longest = column("total_us") > longest ? column("total_us") : longest, 0) nooutput
parts = "compute_us send_us receive_us wait_us contention_us"
array part_name[5] = ["computing", "sending", "receiving", "waiting", "contention"]
array part_colour[5] = [compute_colour, send_colour, recv_colour, wait_colour, contention_colour]
seen = contended >= 0.004*longest ? 5 : 4
if (seen == 4) { subline = subline.(contended > 0 ? sprintf("; contention, at most %.2g µs a stage, is too thin to be seen", contended) : "; no contention") }
# Height of the stack up to and with part j.
up_to(j) = sum [i=1:j] column(word(parts, i))
at(size, v) = column("P") == size ? v : NaN

set yrange [0:top]
set xrange [-0.6:last + 0.6]
unset grid; set grid ytics linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
do for [format in formats] {
    page_wide = 800; page_high = 500
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # the legend, in a frame as wide as the page
    set lmargin at screen 0.05; set rmargin at screen 0.99; set tmargin at screen 0.9; set bmargin at screen 0.22
    unset border; unset tics; unset title; unset ylabel
    set key at screen 0.53,0.89 center top horizontal maxrows 1 samplen 1.2 width 1
    set label 97 headline at screen 0.5,0.97 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.925 center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    plot NaN, for [j=1:seen] keyentry with boxes linewidth 0.6 fillcolor rgb part_colour[j] title part_name[j]
    unset key; unset label 97; unset label 98; unset label 99
    set border 3; set ytics nomirror out scale 0.6
    set xtics scale 0 nomirror format ""
    set tmargin at screen 0.79
    do for [s=1:2] {
        size = int(word(sizes, s))
        set lmargin at screen (s == 1 ? axis_px(letters_even(0, top))/page_wide : 0.56); set rmargin at screen (s == 1 ? 0.52 : 0.99)
        total = NaN
        stats data using (column("P") == size ? (total = column("makespan_us")) : NaN) nooutput
        set title sprintf("n = P = %d: %.0f µs in all", size, total) offset 0,-0.6
        set ylabel (s == 1 ? "mean over the ranks [µs]" : ""); set format y (s == 1 ? "%g" : ""); set format x ""
        plot for [j=5:1:-1] data using (at(size, column("stage"))):(up_to(j)):(0.78) with boxes \
                linewidth 0.6 fillcolor rgb part_colour[j], \
             data using (at(size, column("stage"))):(0):(strcol("name")) with labels rotate by 40 right noenhanced offset 0,-0.7
    }
    unset multiplot
    unset output
}
