# slack.gp - left: how much later each rank may be; right: the largest parts of all ranks' time, and how near they are to the path.
data = figure.".csv"
stats data using (int(column("panel")) == 1 ? (headline = strcol("title"), near_us = column("near_us"), column("y")) : NaN) nooutput
most = STATS_max > 0 ? STATS_max : 1
stats data using (int(column("panel")) == 1 ? column("x") : NaN) nooutput
ranks = STATS_max + 1
stats data using (int(column("panel")) == 2 ? column("x") : NaN) nooutput
parts = STATS_records > 0 ? int(STATS_max) : 1
subline = sprintf("slack: the longest delay that leaves the run as long as it is; nearly critical: at most 5 %% of the run, %.4g µs", near_us)
of(p) = int(column("panel")) == p
do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size 2240,1120 font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size 1120,560 font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset key
    tiny = small(format)
    set multiplot
    set label 97 headline at screen 0.5,0.965 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.918 center noenhanced textcolor rgb grey font tiny
    set label 99 foot(provenance, 1120) at screen 0.99,(0.016 + foot_lift(provenance, 1120)*1.0/560) right noenhanced font least(format) textcolor rgb grey
    set lmargin at screen axis_px(letters_even(-0.03*most, most))/1120; set rmargin at screen 0.46; set tmargin at screen 0.87; set bmargin at screen 0.125
    set xrange [-0.5:ranks - 0.5]; set yrange [-0.03*most:1.06*most]
    set xtics auto offset 0,tick_lift(format); set ytics auto
    set xlabel "rank" offset 0,name_lift(format); set ylabel "slack [µs]"
    plot data using (of(1) && column("y") > 0 ? column("x") : NaN):"y" with points pointtype point[1] pointsize 0.55 linecolor rgb colour[1], \
         data using (of(1) && column("y") == 0 ? column("x") : NaN):"y" with points pointtype point[2] pointsize 0.55 linecolor rgb colour[2], \
         NaN notitle
    unset label 97; unset label 98; unset label 99
    set lmargin at screen 0.685; set rmargin at screen 0.985; set tmargin at screen 0.83
    set xrange [0:100]; set yrange [parts + 0.6:0.4]
    set ytics scale 0 font tiny noenhanced; unset ylabel; set xlabel "share of the time of all ranks and messages [%]" offset 0,name_lift(format)
    set key at screen 0.99,0.885 right top horizontal samplen 1 width (format eq "png" ? -1 : -2) font tiny maxrows 1 maxcols 3
    set boxwidth 0.7
    plot data using (of(2) ? column("critical")/2 : NaN):"x":(column("critical")/2):(0.34) with boxxyerror linewidth 0.3 \
            fillcolor rgb contention_colour title "critical", \
         data using (of(2) ? column("critical") + column("near")/2 : NaN):"x":(column("near")/2):(0.34) with boxxyerror linewidth 0.3 \
            fillcolor rgb send_colour title "nearly", \
         data using (of(2) ? 100 - column("rest")/2 : NaN):"x":(column("rest")/2):(0.34) with boxxyerror linewidth 0.3 \
            fillcolor rgb wait_colour title "more slack", \
         data using (of(2) ? 0 : NaN):"x":ytic(strcol("what")) with points pointtype 0 notitle
    unset key; unset ytics; set ytics auto nomirror out scale 0.6
    unset multiplot
    unset output
}
