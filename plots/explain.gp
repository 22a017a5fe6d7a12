# explain.gp - where in the plane of two parameters a claim holds: one cell a simulated point, blue where it holds.
data = figure.".csv"
stats data using (headline = "What would make ".strcol("subject")." hold", claim = strcol("statement"), variant = strcol("variant"), \
    x_label = strcol("x_label"), y_label = strcol("y_label"), x_share = column("x_share"), y_share = column("y_share"), \
    x_low = column("x_low"), x_high = column("x_high"), y_low = column("y_low"), y_high = column("y_high"), \
    x_nominal = column("x_nominal"), y_nominal = column("y_nominal"), x_answer = column("x_answer"), y_answer = column("y_answer"), \
    verdict = strcol("verdict"), 0) nooutput
stats data using "i" nooutput
columns = int(STATS_max) + 1
stats data using "j" nooutput
rows = int(STATS_max) + 1
array px[columns]; array py[rows]
stats data using (px[int(column("i")) + 1] = column("x"), py[int(column("j")) + 1] = column("y"), 0) nooutput
stats data using "holds" nooutput
holding = int(STATS_sum + 0.5); cells = int(STATS_records)
subline = sprintf("%d of %d points hold, judged for '%s'; the other parameters as in the answer", holding, cells, variant)
# a position on an axis is counted in cells; between two of them the logarithm or the share is followed
place(v, low, high, n, share) = share == 1 ? (v - low)/(high - low)*(n - 1) : log(v/low)/log(high/low)*(n - 1)
at_x(v) = place(v, px[1], px[columns], columns, x_share)
at_y(v) = place(v, py[1], py[rows], rows, y_share)
told(v) = v == v
set palette defined (-1 "#b0401a", -0.3 "#e08a5a", -0.0001 "#fbe3d3", 0 "#d5e8f3", 0.3 "#56b4e9", 1 "#08306b")
set cbrange [-1:1]
set xrange [-0.5:columns - 0.5]; set yrange [-0.5:rows - 0.5]
unset grid
name(v, share) = share == 1 ? sprintf("%.0f %%%%", 100*v) : sprintf("%.3g", v)
do for [format in formats] {
    wide = 860.0; high = 640.0
    page_wide = int(wide); page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set label 97 headline at screen 0.5,1.0 - 20.0/high center noenhanced font large(format)
    set label 98 subline at screen 0.5,1.0 - 20.0/high - 0.032 center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set label 96 claim at screen 0.5,(1.0 - 64.0/high) center noenhanced font tiny textcolor rgb grey
    set lmargin at screen 0.11; set rmargin at screen 0.82; set tmargin at screen 1.0 - 90.0/high; set bmargin at screen 96.0/high
    set xlabel x_label noenhanced offset 0,name_lift(format); set ylabel y_label noenhanced offset 0.8,0
    set xtics scale 0 font tiny offset 0,tick_lift(format); set ytics scale 0 font tiny; set xtics (0); set ytics (0)
    do for [k=1:columns:2] { set xtics add (name(px[k], x_share) k - 1) }
    do for [k=1:rows:2] { set ytics add (name(py[k], y_share) k - 1) }
    set colorbox user origin screen 0.85,(120.0/high) size screen 0.022,(1.0 - 220.0/high)
    set cblabel "margin: below 0 the claim fails" offset 0.6,0
    unset key
    set object 1 rectangle from (told(x_low) ? at_x(x_low) : -0.5),(told(y_low) ? at_y(y_low) : -0.5) \
        to (told(x_high) ? at_x(x_high) : columns - 0.5),(told(y_high) ? at_y(y_high) : rows - 0.5) \
        front fillstyle empty border linecolor rgb "#000000" linewidth 1.2 dashtype 2
    if (!told(x_low) && !told(y_low)) { unset object 1 }
    set label 95 "dashed: published range;  o: unchanged;  x: solution;  each cell shows the point in its middle" at screen 0.11,(26.0/high) left noenhanced font tiny textcolor rgb grey
    # A white disc below each black mark: black alone is lost on the dark cells.
    plot data using "i":"j":(0.5):(0.5):"margin" with boxxyerror linewidth 0 fillcolor palette, \
         data using (column("holds") == 1 ? column("i") : NaN):"j" with points pointtype 7 pointsize 0.5 linecolor rgb "#ffffff", \
         "+" using (at_x(x_nominal)):(at_y(y_nominal)) every ::0::0 with points pointtype 7 pointsize 1.7 linecolor rgb "#ffffff", \
         "+" using (at_x(x_nominal)):(at_y(y_nominal)) every ::0::0 with points pointtype 6 pointsize 1.4 linewidth 2.4 linecolor rgb "#000000", \
         "+" using (verdict eq "holds" ? at_x(x_answer) : NaN):(at_y(y_answer)) every ::0::0 with points pointtype 7 pointsize 1.9 linecolor rgb "#ffffff", \
         "+" using (verdict eq "holds" ? at_x(x_answer) : NaN):(at_y(y_answer)) every ::0::0 with points pointtype 2 pointsize 1.4 linewidth 2.4 linecolor rgb "#000000"
    unset label 95; unset label 96; unset label 97; unset label 98; unset label 99; unset object 1
    unset multiplot
    unset output
}
