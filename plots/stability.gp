# stability.gp - a table of marks: rows are cases, columns algorithms; in each cell the power of ten of the error. Or, for
# the motions of stiff cases: in each cell error, step, evaluations and energy drift.
data = figure.".csv"
cases = figure.".cases.csv"
stats data using "x" nooutput
columns = int(STATS_max)
stats data using "y" nooutput
rows = int(STATS_max)
motions = 0; explicit = 0; own = 0
array algorithm[columns]
array grade_count[3]; do for [i=1:3] { grade_count[i] = 0 }
stats data using (motions = column("motion") == 1, x = int(column("x")), algorithm[x] = strcol("algorithm"), \
    own = motions && strcol("algorithm")[1:4] eq "own " && column("implicit") == 0 && x > own ? x : own, \
    explicit = column("implicit") == 0 && x > explicit ? x : explicit, \
    grade_count[int(column("grade")) + 1] = grade_count[int(column("grade")) + 1] + 1, \
    headline = "Stability".(strcol("suite") eq "suite" ? "" : " of ".strcol("suite")).": ".strcol("what"), 0) nooutput
longest = 6
stats cases using (longest = strlen(strcol("name")) > longest ? strlen(strcol("name")) : longest, 0) nooutput
subline = sprintf("%d ok, %d degraded, %d failed", grade_count[1], grade_count[2], grade_count[3])
note = motions ? "built-in integrators: largest stable step by bisection (model time), then from half of it on as many steps as 1 % needs;  others: tolerance 1e-6, mean step" : \
    "number: power of ten of the relative error;  =0: no error;  ×: no result;  –: unknown;  blank: not applicable"
array grade_name[3] = ["ok", "degraded", "failed"]
array grade_colour[3] = [good_colour, middle_colour, bad_colour]
array grade_ink[3] = ["#000000", "#000000", "#ffffff"]
array info_name[4] = ["condition of the scene", "growth of the reduction", "worst residual (double)", "energy drift, motions"]
is(grade) = column("grade") == grade
power(x) = x > 0 ? sprintf("%.0e", x) : x == 0 ? "=0" : ""
count(x) = x > 0 ? (x < 1e6 ? sprintf("%.0f", x) : sprintf("%.1e", x)) : "–"
named(k) = algorithm[k][1:4] eq "own " && k <= own ? algorithm[k][5:*] : algorithm[k]

# a cell, and what stands left and right of all: names of the cases, numbers that belong to them
cell_high = motions ? 66.0 : 19.0
left_edge = 20 + 6.9*longest + (motions ? 84 : 0); left_edge = left_edge > 110 ? left_edge : 110.0
info_wide = motions ? 100.0 : 190.0
wide = 1000.0; upper = motions ? 160.0 : 240.0
total = upper + cell_high*(rows + (motions ? 0 : 0.5)) + 34
cell_wide = (wide - left_edge - info_wide - (motions ? 16 : 62))/columns; cell_wide = cell_wide > 90 ? 90.0 : cell_wide
beyond(px) = columns + 0.5 + px/cell_wide   # so far right of the last cell
at_x(px) = px/wide; at_y(px) = 1.0 - px/total
place(x) = motions && x > explicit ? x + 0.2 : x    # explicit and implicit steppers stand apart

do for [format in formats] {
    page_wide = int(wide); page_high = int(total)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    unset grid; unset border; unset tics
    set label 97 headline at screen 0.5,at_y(18) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 96 note at screen at_x(14),at_y(66) left noenhanced font tiny textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,at_y(total - 9 - foot_lift(provenance, page_wide)) right noenhanced font least(format) textcolor rgb grey
    # the frame is as wide as the page, so that names and numbers beside the cells are inside
    set lmargin at screen at_x(4); set rmargin at screen at_x(wide - 4)
    set tmargin at screen at_y(upper); set bmargin at screen at_y(upper + cell_high*(rows + (motions ? 0 : 0.5)))
    set xrange [0.5 - (left_edge - 4)/cell_wide:0.5 + (wide - 4 - left_edge)/cell_wide]; set yrange [rows + (motions ? 0.5 : 0.9):(motions ? 0.5 : 0.4)]
    set key at screen at_x(wide - 14),at_y(76) right top horizontal maxrows 1 samplen 1.2 width 1
    if (motions) {
        do for [i=1:columns] { set label 10+i named(i) at first place(i),graph 1.0 center noenhanced font tiny offset 0,0.5 }
        if (own > 0) { set label 55 "own, explicit" at first (1 + own)/2.0,graph 1.0 center font tiny offset 0,1.9 textcolor rgb colour[1] }
        if (explicit > own) { set label 51 "explicit" at first (own + 1 + explicit)/2.0,graph 1.0 center font tiny offset 0,1.9 textcolor rgb colour[1] }
        if (columns > explicit) { set label 52 "implicit" at first (explicit + columns + 1)/2.0 + 0.2,graph 1.0 center font tiny offset 0,1.9 textcolor rgb colour[1] }
        set label 53 "evaluations:" at first beyond(60),graph 1.0 center font tiny offset 0,1.9 textcolor rgb grey
        set label 54 "explicit / implicit" at first beyond(60),graph 1.0 center font tiny offset 0,0.5 textcolor rgb grey
        plot for [j=0:2] data using (is(j) ? place(column("x")) : NaN):"y":(0.48):(0.47) with boxxyerror linewidth 0.3 fillcolor rgb grade_colour[j+1] title grade_name[j+1], \
             for [j=0:2] data using (is(j) ? place(column("x")) : NaN):(column("y") - 0.33):(strcol("error_text")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             for [j=0:2] data using (is(j) ? place(column("x")) : NaN):(column("y") - 0.11):(strcol("step_text")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             for [j=0:2] data using (is(j) ? place(column("x")) : NaN):(column("y") + 0.11):(count(column("evaluations"))) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             for [j=0:2] data using (is(j) ? place(column("x")) : NaN):(column("y") + 0.33):(strcol("drift_text")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             cases using (beyond(60)):"y":(strcol("ratio")) with labels noenhanced font tiny textcolor rgb grey, \
             cases using (0.42 - 84/cell_wide):"y":(strcol("name")) with labels right noenhanced font tiny, \
             for [j=0:3] cases using (0.42):(column("y") - 0.33 + 0.22*j):(word("error step evaluations energy", j + 1)) with labels right noenhanced font tiny textcolor rgb grey
    } else {
        do for [i=1:columns] { set label 10+i algorithm[i] at first i,graph 1.0 left rotate by 55 noenhanced font tiny offset 0,0.4 }
        do for [i=1:4] { set label 50+i info_name[i] at first beyond(46*i - 26),graph 1.0 left rotate by 55 noenhanced font tiny offset 0,0.4 textcolor rgb grey }
        plot for [j=0:2] data using (is(j) ? column("x") : NaN):"y":(0.48):(0.47) with boxxyerror linewidth 0.3 \
                fillcolor rgb grade_colour[j+1] title grade_name[j+1], \
             for [j=0:2] data using (is(j) ? column("x") : NaN):"y":(stringcolumn("decade")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             cases using (column("heading") == 0 ? 0.35 : NaN):"y":(strcol("name")) with labels right noenhanced font tiny, \
             cases using (column("heading") == 1 ? 0.35 : NaN):(column("y") + 0.1):(strcol("name")) with labels right noenhanced \
                font tiny textcolor rgb colour[1], \
             cases using (column("heading") == 0 ? beyond(22) : NaN):"y":(power(column("condition"))) with labels noenhanced font tiny textcolor rgb grey, \
             cases using (column("heading") == 0 ? beyond(68) : NaN):"y":(power(column("growth"))) with labels noenhanced font tiny textcolor rgb grey, \
             cases using (column("heading") == 0 ? beyond(114) : NaN):"y":(power(column("residual"))) with labels noenhanced font tiny textcolor rgb grey, \
             cases using (column("heading") == 0 ? beyond(160) : NaN):"y":(power(column("energy"))) with labels noenhanced font tiny textcolor rgb grey
    }
    do for [i=1:columns] { unset label 10+i }
    do for [i=51:55] { unset label i }
    unset multiplot
    unset output
}
