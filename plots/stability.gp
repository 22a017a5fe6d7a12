# stability.gp - a table of marks: rows are cases, columns algorithms; in each cell the power of ten of the error. Below it
# the motions of stiff cases: in each cell error, step, evaluations and energy drift.
data = figure.".csv"
cases = figure.".cases.csv"
stats data using (column("motion") == 0 ? column("x") : NaN) nooutput
columns = int(STATS_max)
stats data using (column("motion") == 0 ? column("y") : NaN) nooutput
high_rows = int(STATS_max)
motions = 0; steppers = 0; explicit = 0; own = 0
array algorithm[columns + 1]
array grade_count[3]; do for [i=1:3] { grade_count[i] = 0 }
stats data using (column("motion") == 1 ? (motions = column("y") > motions ? int(column("y")) : motions, \
        steppers = column("x") > steppers ? int(column("x")) : steppers, \
        own = strcol("algorithm")[1:4] eq "own " && column("implicit") == 0 && column("x") > own ? int(column("x")) : own, \
        explicit = column("implicit") == 0 && column("x") > explicit ? int(column("x")) : explicit) : \
        (algorithm[int(column("x"))] = strcol("algorithm"), 0), \
    grade_count[int(column("grade")) + 1] = grade_count[int(column("grade")) + 1] + 1, \
    headline = strcol("suite") eq "suite" ? "Stability: stiff and extreme cases against algorithms" : "Stability: ".strcol("suite"), 0) nooutput
array stepper[steppers + 1]
if (motions > 0) { stats data using (column("motion") == 1 ? (stepper[int(column("x"))] = strcol("algorithm")[1:4] eq "own " && column("implicit") == 0 ? strcol("algorithm")[5:*] : strcol("algorithm"), 0) : 0) nooutput }
subline = sprintf("%d ok, %d degraded, %d failed", grade_count[1], grade_count[2], grade_count[3])
array grade_name[3] = ["ok", "degraded", "failed"]
array grade_colour[3] = ["#d5e8f3", "#f0c060", "#b0401a"]
array grade_ink[3] = ["#000000", "#000000", "#ffffff"]
is(m, grade) = column("motion") == m && column("grade") == grade

left_edge = 190.0; right_edge = 70.0; # of the cells; names stand left of them
info = 4.0                                # columns of numbers beside the accelerations
wide = left_edge + right_edge + 30.0*(columns + 0.4 + 1.35*info); wide = wide > 1100.0 ? wide : 1100.0
 cell_high = 17.0; stiff_high = 62.0
upper = 236.0
upper_end = upper + cell_high*(high_rows + 0.5)
lower = upper_end + 112
lower_end = lower + stiff_high*motions
total = (motions > 0 ? lower_end : upper_end) + 30
at_x(px) = px/wide; at_y(px) = 1.0 - px/total
place(x) = x > explicit ? x + 0.25 : x    # explicit and implicit steppers stand apart

do for [format in formats] {
    page_wide = int(wide); page_high = int(total)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = format eq "png" ? ",15" : ",10.5"; strong = format eq "png" ? ",20" : ",13.5"
    set multiplot
    unset grid; unset border; unset tics
    set label 97 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 99 provenance at screen 0.99,0.012 right noenhanced font least(format) textcolor rgb grey
    set label 1 "Accelerations and short motions" at screen at_x(14),at_y(72) left font strong
    set label 2 "number: power of ten of the relative error (accelerations: against quad precision; short motions: against a tight tolerance);  =0: no error;  ×: no result;  –: unknown;  blank: not applicable" \
        at screen at_x(14),at_y(92) left noenhanced font tiny textcolor rgb "#505050"
    set lmargin at screen at_x(14); set rmargin at screen at_x(wide - right_edge)
    set tmargin at screen at_y(upper); set bmargin at screen at_y(upper_end)
    across = columns + 0.4 + 1.35*info
    unit = (wide - left_edge - right_edge)/across
    set xrange [0.5 - (left_edge - 14)/unit:across + 0.5]; set yrange [high_rows + 0.9:0.4]
    set key at screen at_x(wide - 20),at_y(64) right top horizontal maxrows 1 samplen 1.2 width 1
    do for [i=1:columns] { set label 10+i algorithm[i] at first i,graph 1.0 left rotate by 50 noenhanced font tiny offset 0,0.4 }
    array info_name[4] = ["condition of the scene", "growth of the reduction", "worst residual (double)", "energy drift, motions"]
    do for [i=1:4] { set label 50+i info_name[i] at first (columns + 0.2 + 1.35*i),graph 1.0 left rotate by 50 noenhanced font tiny offset 0,0.4 textcolor rgb "#505050" }
    power(x) = x > 0 ? sprintf("%.0e", x) : x == 0 ? "=0" : ""
    plot for [j=0:2] data using (is(0, j) ? column("x") : NaN):"y":(0.48):(0.47) with boxxyerror linewidth 0.3 \
            fillcolor rgb grade_colour[j+1] title grade_name[j+1], \
         for [j=0:2] data using (is(0, j) ? column("x") : NaN):"y":(stringcolumn("decade")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
         cases using (column("motion") == 0 && column("heading") == 0 ? 0.35 : NaN):"y":(strcol("name")) with labels right noenhanced font tiny, \
         cases using (column("motion") == 0 && column("heading") == 1 ? 0.35 : NaN):(column("y") + 0.1):(strcol("name")) with labels right noenhanced \
            font tiny textcolor rgb "#0072b2", \
         cases using (column("motion") == 0 && column("heading") == 0 ? columns + 1.55 : NaN):"y":(power(column("condition"))) with labels noenhanced font tiny textcolor rgb "#505050", \
         cases using (column("motion") == 0 && column("heading") == 0 ? columns + 2.9 : NaN):"y":(power(column("growth"))) with labels noenhanced font tiny textcolor rgb "#505050", \
         cases using (column("motion") == 0 && column("heading") == 0 ? columns + 4.25 : NaN):"y":(power(column("residual"))) with labels noenhanced font tiny textcolor rgb "#505050", \
         cases using (column("motion") == 0 && column("heading") == 0 ? columns + 5.6 : NaN):"y":(power(column("energy"))) with labels noenhanced font tiny textcolor rgb "#505050"
    do for [i=1:columns] { unset label 10+i }
    do for [i=1:4] { unset label 50+i }
    unset label 97; unset label 98; unset label 99
    if (motions > 0) {
        set label 1 "Motions of stiff cases" at screen at_x(14),at_y(lower - 82) left font strong
        set label 2 "built-in integrators: largest stable step by bisection (model time), then from half of it on as many steps as 1% needs;  others: tolerance 1e-6, mean step;  not run: evaluations needed" \
            at screen at_x(14),at_y(lower - 62) left noenhanced font tiny textcolor rgb "#505050"
        set tmargin at screen at_y(lower); set bmargin at screen at_y(lower_end)
        unit = (wide - left_edge - 90 - 14)/(steppers + 1.75)
        set rmargin at screen at_x(wide - 14); set xrange [0.5 - (left_edge + 90 - 14)/unit:steppers + 2.25]; set yrange [motions + 0.5:0.5]
        unset key
        do for [i=1:steppers] { set label 10+i stepper[i] at first place(i),graph 1.0 center noenhanced font tiny offset 0,0.5 }
        if (own > 0) { set label 55 "own, explicit" at first (1 + own)/2.0,graph 1.0 center font tiny offset 0,2 textcolor rgb "#0072b2" }
        set label 51 "explicit" at first (own + 1 + explicit)/2.0,graph 1.0 center font tiny offset 0,2 textcolor rgb "#0072b2"
        set label 52 "implicit" at first (explicit + steppers + 1)/2.0 + 0.25,graph 1.0 center font tiny offset 0,2 textcolor rgb "#0072b2"
        set label 53 "evaluations:" at first steppers + 1.5,graph 1.0 center font tiny offset 0,2 textcolor rgb "#505050"
        set label 54 "explicit / implicit" at first steppers + 1.5,graph 1.0 center font tiny offset 0,0.5 textcolor rgb "#505050"
        count(x) = x > 0 ? (x < 1e6 ? sprintf("%.0f", x) : sprintf("%.1e", x)) : "–"
        plot for [j=0:2] data using (is(1, j) ? place(column("x")) : NaN):"y":(0.49):(0.47) with boxxyerror linewidth 0.3 fillcolor rgb grade_colour[j+1], \
             for [j=0:2] data using (is(1, j) ? place(column("x")) : NaN):(column("y") - 0.33):(strcol("error_text")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             for [j=0:2] data using (is(1, j) ? place(column("x")) : NaN):(column("y") - 0.11):(strcol("step_text")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             for [j=0:2] data using (is(1, j) ? place(column("x")) : NaN):(column("y") + 0.11):(count(column("evaluations"))) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             for [j=0:2] data using (is(1, j) ? place(column("x")) : NaN):(column("y") + 0.33):(strcol("drift_text")) with labels noenhanced font tiny textcolor rgb grade_ink[j+1], \
             cases using (column("motion") == 1 ? steppers + 1.5 : NaN):"y":(strcol("ratio")) with labels noenhanced font tiny, \
             cases using (column("motion") == 1 ? 0.5 - 84/unit : NaN):"y":(strcol("name")) with labels right noenhanced font tiny, \
             cases using (column("motion") == 1 ? 0.44 : NaN):(column("y") - 0.33):("error") with labels right noenhanced font tiny textcolor rgb grey, \
             cases using (column("motion") == 1 ? 0.44 : NaN):(column("y") - 0.11):("step") with labels right noenhanced font tiny textcolor rgb grey, \
             cases using (column("motion") == 1 ? 0.44 : NaN):(column("y") + 0.11):("evaluations") with labels right noenhanced font tiny textcolor rgb grey, \
             cases using (column("motion") == 1 ? 0.44 : NaN):(column("y") + 0.33):("energy drift") with labels right noenhanced font tiny textcolor rgb grey
        do for [i=1:steppers] { unset label 10+i }
        do for [i=51:55] { unset label i }
    }
    unset label 1; unset label 2
    unset multiplot
    unset output
}
