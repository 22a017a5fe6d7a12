# _timeline.gp - a timeline: per row a bar of what a rank or a group of ranks does, above all a ribbon of the stage; arrows are
# messages, the line with a white edge is the critical path; below it how many ranks do what.
data = figure.".csv"; about = figure.".about.csv"; share = figure.".share.csv"
path = figure.".path.csv"; messages = figure.".messages.csv"; stage_file = figure.".stages.csv"
stats about using (headline = strcol("title"), rows = int(column("rows")), first = int(column("first_rank")), last = int(column("last_rank")), \
    from = column("begin_us"), to = column("end_us"), total = column("makespan_us"), single = column("single") == 1, \
    has_path = column("path") == 1, arrows = column("messages") > 0, stages = int(column("stages")), 0) nooutput
ranks = last - first + 1
subline = (ranks > rows ? sprintf("ranks %d to %d in %d rows, each shows what its ranks do most", first, last, rows) : sprintf("ranks %d to %d", first, last)). \
    sprintf(";  %.6g to %.6g of %.6g µs", from, to, total).(has_path ? ";  black line: critical path" : "")
array stage_name[stages + 1]
stats stage_file using (column("stage") >= 0 ? (stage_name[int(column("stage")) + 1] = strcol("name"), 0) : 0) nooutput
array stage_colour[8] = ["#1b7837", "#7fbf7b", "#40004b", "#9970ab", "#01665e", "#80cdc1", "#8c510a", "#dfc27d"]
array kind_name[5] = ["computing", "sending", "receiving", "waiting", "barrier"]
array kind_colour[5] = [compute_colour, send_colour, recv_colour, wait_colour, "#a9a9b8"]
kinds = "compute send recv wait barrier"
up_to(j) = sum [i=1:j] column(word(kinds, i))
tone(k) = (k - 1) % 8 + 1
# a row is as high as there is room for
row_high = single ? (rows <= 8 ? 58 : rows <= 16 ? 36 : 16) : 440.0/rows
named = stages <= 10
upper = 96.0 + (named && stages > 0 ? 22*ceil(stages/5.0) : 0); ribbon = stages > 0 ? 14 : 0
bars_high = row_high*rows; share_top = upper + ribbon + bars_high + 62; share_high = 120.0
wide = 1000.0; high = share_top + share_high + 76
at_y(px) = 1.0 - px/high
bar = single && rows <= 16 ? 0.36 : single ? 0.42 : 0.5
unit = to - from

do for [format in formats] {
    page_wide = int(wide); page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # two legends, in frames as wide as the page
    set lmargin at screen 0.03; set rmargin at screen 0.99; set tmargin at screen 0.98; set bmargin at screen 0.05
    unset border; unset tics; unset grid; set xrange [0:1]; set yrange [0:1]
    set label 97 headline at screen 0.5,at_y(18) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,at_y(high - 9 - foot_lift(provenance, page_wide)) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.53,at_y(54) center top horizontal maxrows 1 samplen 1.2 width 1
    plot NaN, for [j=1:5] keyentry with boxes linewidth 0.6 fillcolor rgb kind_colour[j] title kind_name[j]
    unset label 97; unset label 98; unset label 99
    if (named && stages > 0) {
        set key at screen 0.53,at_y(76) center top horizontal maxcols 5 samplen 1 width 0
        plot NaN, for [j=1:stages] keyentry with boxes linewidth 0.3 fillcolor rgb stage_colour[tone(j)] title stage_name[j]
    }
    unset key
    set lmargin at screen axis_px(strlen(sprintf("%d", last)))/wide; set rmargin at screen 0.985
    set xrange [from:to]
    # the stage that most time is spent in
    if (stages > 0) {
        set tmargin at screen at_y(upper); set bmargin at screen at_y(upper + ribbon - 4)
        set yrange [0:1]
        plot for [j=1:stages] share using ((column("begin_us") + column("end_us"))/2):(column("stage") == j - 1 ? 0.5 : NaN): \
            ((column("end_us") - column("begin_us"))/2):(0.5) with boxxyerror fillstyle solid noborder fillcolor rgb stage_colour[tone(j)]
    }
    set border 3 linewidth 0.8
    set tmargin at screen at_y(upper + ribbon); set bmargin at screen at_y(upper + ribbon + bars_high)
    set yrange [rows - 0.5:-0.5]
    set xtics nomirror out scale 0.6 format "%g" offset 0,tick_lift(format)
    if (ranks <= rows && rows <= 16) { set ytics 1 scale 0 format "%g" } else { set ytics scale 0.5 out nomirror; set ytics (sprintf("%d", first) 0, sprintf("%d", last) rows - 1, \
        sprintf("%d", first + ranks/4) rows/4.0, sprintf("%d", first + ranks/2) rows/2.0, sprintf("%d", first + 3*ranks/4) 3*rows/4.0) }
    if (first > 0 && ranks <= rows && rows <= 16) { set ytics (sprintf("%d", first) 0); do for [i=1:rows-1] { set ytics add (sprintf("%d", first + i) i) } }
    set ylabel "rank"; unset xlabel
    # edges hide thin bars
    if (single) { set style fill solid 1.0 border linecolor rgb "#303030" } else { set style fill solid 1.0 noborder }
    plot for [j=5:1:-1] data using ((column("begin_us") + column("end_us"))/2):(column("kind") == j - 1 ? column("y") : NaN): \
            ((column("end_us") - column("begin_us"))/2):(bar) with boxxyerror linewidth 0.3 fillcolor rgb kind_colour[j], \
         messages using "sent_us":"from_y":(column("received_us") - column("sent_us")):(column("to_y") - column("from_y")) with vectors \
            head filled size unit*0.006,18 linewidth 0.7 linecolor rgb "#555555", \
         path using "from_us":"from_y":(column("to_us") - column("from_us")):(column("to_y") - column("from_y")) with vectors nohead \
            linewidth (rows <= 16 ? 3.6 : 5) linecolor rgb "#ffffff", \
         path using "from_us":"from_y":(column("to_us") - column("from_us")):(column("to_y") - column("from_y")) with vectors nohead \
            linewidth (rows <= 16 ? 1.8 : 2.4) linecolor rgb "#000000"
    # how many ranks do what
    set tmargin at screen at_y(share_top); set bmargin at screen at_y(share_top + share_high)
    set yrange [0:ranks]; set ytics autofreq scale 0.6 format "%g"; if (ranks <= 8) { set ytics 1 }
    set xlabel "simulated time [µs]" offset 0,name_lift(format); set ylabel "ranks"
    plot for [j=5:1:-1] share using ((column("begin_us") + column("end_us"))/2):(up_to(j)) with filledcurves y1=0 fillstyle solid noborder fillcolor rgb kind_colour[j]
    unset xlabel; unset ylabel
    unset multiplot
    unset output
}
