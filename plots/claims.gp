# claims.gp - a table of marks: rows are claims, cells their variants; in each cell the share of samples that pass.
data = figure.".csv"
stats data using "y" nooutput
rows = int(STATS_max)
stats data using "columns" nooutput
columns = int(STATS_max)
array claim[rows]; array upper[columns]; array lower[columns]; array style[columns]
do for [i=1:columns] { upper[i] = ""; lower[i] = ""; style[i] = 0 }
pass = 0; open = 0; fail = 0
stats data using (claim[int(column("y"))] = strcol("statement"), k = strcol("kind"), g = column("grade"), \
    (k eq "baseline" ? (upper[int(column("x"))] = strcol("head"), lower[int(column("x"))] = strcol("head2"), \
                        style[int(column("x"))] = column("style")) : ""), v = k eq "verdict", pass = pass + (v && g == 0), \
    open = open + (v && g == 1), fail = fail + (v && g == 2), 0) nooutput
# columns of structured operators stand first
structured = 0
do for [i=1:columns] { structured = structured + (style[i] == 1) }
# a statement of more than 54 letters takes two lines, parted at the last blank of its first half and a little more
blank(s, k) = k < 2 || s[k:k] eq " " ? k : blank(s, k - 1)
part(s, k) = s[1:k - 1]."\n".s[k + 1:strlen(s)]
short(s) = strlen(s) > 130 ? s[1:129]."…" : s
wrap(s) = strlen(s) > 46 ? part(s, blank(s, int(strlen(s)/2) + 5)) : s
headline = "The claims of the paper"
subline = sprintf("%d pass, %d fail, %d not testable.  First cell: in how many variants a claim holds.  Thick frame: the variant that gives the verdict.", pass, fail, open)
note = "Percentage: share of the samples of the machine's parameters in which the variant holds;  yes, no: not sampled."
is(grade, v) = column("grade") == grade ? v : NaN
named(v) = strcol("kind") eq "named" ? v : NaN
other(v) = strcol("kind") ne "named" ? v : NaN
ink(v) = int(v) == 2 ? 0xffffff : 0x000000
array grade_name[3] = ["pass", "not testable", "fail"]
array grade_colour[3] = [good_colour, "#f4f4f4", bad_colour]
wide = 1140.0; cells_left = 352.0; upper_px = 172.0; row_high = 46.0
high = upper_px + row_high*rows + 34
at_y(px) = 1.0 - px/high
do for [format in formats] {
    page_wide = int(wide); page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format); fine = format eq "png" ? ",13" : ",9"
    set multiplot
    unset grid
    set lmargin at screen cells_left/wide; set rmargin at screen 1.0 - 8/wide
    set tmargin at screen at_y(upper_px); set bmargin at screen at_y(upper_px + row_high*rows)
    set xrange [-1.3:columns + 0.52]; set yrange [rows + 0.5:0.5]
    unset border; unset xtics; unset ytics
    do for [i=1:columns] {
        set label 100+i upper[i] at first i,screen at_y(upper_px - 27) center noenhanced font fine
        set label 130+i lower[i] at first i,screen at_y(upper_px - 12) center noenhanced font fine
    }
    set label 160 (structured > 0 ? "structured operators, over the serial code" : "") at first 0.55,screen at_y(upper_px - 46) left font tiny textcolor rgb grey
    set label 161 (structured < columns && style[columns] == 2 ? "dense operators, over the serial code" : "") at first structured + 0.55,screen at_y(upper_px - 46) left font tiny textcolor rgb grey
    set label 162 "verdict" at first -0.4,screen at_y(upper_px - 12) center font fine
    do for [i=1:rows] {
        set label 200+i wrap(short(claim[i])) at first -1.3,i right noenhanced font tiny offset -0.4,(strlen(claim[i]) > 46 ? 0.35 : 0)
    }
    set label 97 headline at screen 0.5,at_y(18) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(46) center noenhanced font tiny textcolor rgb grey
    set label 96 note at screen 0.5,at_y(66) center noenhanced font tiny textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,at_y(high - 9 - foot_lift(provenance, page_wide)) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.5,at_y(78) center top horizontal maxrows 1 samplen 1.2 width 1
    plot for [j=0:2] data using (is(j, column("x"))):"y":"half":(0.44) with boxxyerror linewidth 0.3 \
            fillcolor rgb grade_colour[j+1] title grade_name[j+1], \
         data using (column("nominal") == 1 ? column("x") : NaN):"y":"half":(0.44) with boxxyerror fillstyle empty linewidth 2 \
            linecolor rgb "#000000", \
         data using (other(column("x"))):"y":(stringcolumn("mark")):(ink(column("grade"))) with labels noenhanced font tiny \
            textcolor rgb variable, \
         data using (named(column("x"))):(column("y") + 0.26):(stringcolumn("mark")):(ink(column("grade"))) with labels noenhanced \
            font tiny textcolor rgb variable, \
         data using (named(column("x"))):(column("y") - 0.27):(stringcolumn("upper")):(ink(column("grade"))) with labels noenhanced \
            font fine textcolor rgb variable, \
         data using (named(column("x"))):(column("y") - 0.02):(stringcolumn("lower")):(ink(column("grade"))) with labels noenhanced \
            font fine textcolor rgb variable
    unset multiplot
    unset output
}
