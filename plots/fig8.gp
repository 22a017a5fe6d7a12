# fig8.gp - a timeline: per rank a bar of what it does, above it a ribbon of its stage; arrows are messages.
data = figure.".csv"
messages = figure.".messages.csv"
stats data using "rank" nooutput
last = int(STATS_max)
stats data using "stage" nooutput
stages = int(STATS_max)
total = 0
array stage_name[stages + 1]
do for [i=1:stages+1] { stage_name[i] = "" }
stats data using (total = column("makespan_us"), stage_name[int(column("stage")) + 1] = strcol("name"), \
    headline = sprintf("Timeline of one evaluation, n = %d, P = %d, on %s", column("n"), column("P"), strcol("machine")), \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators, network level ".strcol("level"), 0) nooutput
# stages of inverse dynamics in greens, of forward dynamics in purples
array stage_colour[8] = ["#9e9e9e", "#1b7837", "#5aae61", "#a6dba0", "#40004b", "#762a83", "#c2a5cf", "#e8e8e8"]
kinds = "compute send recv wait barrier"
array kind_name[5] = ["computing", "sending", "receiving", "waiting", "barrier"]
array kind_colour[5] = [compute_colour, send_colour, recv_colour, wait_colour, "#a9a9b8"]
is(kind, v) = strcol("kind") eq kind ? v : NaN

unset grid; set grid xtics linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
do for [format in formats] {
    page_wide = 800; page_high = int(252 + 70*(last + 1))
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # two legends, in frames as wide as the page
    set lmargin at screen 0.05; set rmargin at screen 0.99; set tmargin at screen 0.9; set bmargin at screen 0.2
    unset border; unset tics; set xrange [0:1]; set yrange [0:1]
    set label 97 headline at screen 0.5,0.965 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.925 center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.53,0.898 center top horizontal maxrows 1 samplen 1.2 width 0
    plot NaN, for [j=1:5] keyentry with boxes linewidth 0.6 fillcolor rgb kind_colour[j] title kind_name[j]
    unset label 97; unset label 98; unset label 99
    set key at screen 0.53,0.858 center top horizontal maxrows 2 samplen 1 width -1
    plot NaN, for [j=1:stages+1] keyentry with boxes linewidth 0.3 fillcolor rgb stage_colour[j] title stage_name[j]
    unset key
    set border 1
    set lmargin at screen 0.08; set rmargin at screen 0.985; set tmargin at screen 0.77; set bmargin at screen 0.13
    set xrange [0:total*1.001]; set yrange [last + 0.5:-0.5]
    set xtics nomirror out scale 0.6 offset 0,tick_lift(format); set ytics 1 scale 0 format "%.0f"
    set xlabel "simulated time [µs]" offset 0,name_lift(format); set ylabel "rank"
    plot for [j=1:stages+1] data using ((column("begin_us") + column("end_us"))/2): \
            (column("stage") == j-1 ? column("rank") - 0.33 : NaN):((column("end_us") - column("begin_us"))/2):(0.05) \
            with boxxyerror fillstyle solid noborder fillcolor rgb stage_colour[j], \
         for [j=1:5] data using ((column("begin_us") + column("end_us"))/2): \
            (is(word(kinds, j), column("rank"))):((column("end_us") - column("begin_us"))/2):(0.24) \
            with boxxyerror linewidth 0.3 fillcolor rgb kind_colour[j], \
         messages using "sent_us":"from_rank":(column("received_us") - column("sent_us")): \
            (column("to_rank") - column("from_rank")) with vectors head filled size total*0.008,18 linewidth 0.9 \
            linecolor rgb "#000000"
    unset xlabel; unset ylabel
    unset multiplot
    unset output
}
