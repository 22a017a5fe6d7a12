# claims.gp - a table of marks: rows are claims, cells their variants; in each cell the share of samples that pass.
data = figure.".csv"
stats data using "y" nooutput
rows = int(STATS_max)
stats data using "columns" nooutput
columns = int(STATS_max)
array claim[rows]; array variant[columns]
do for [i=1:columns] { variant[i] = "" }
pass = 0; open = 0; fail = 0
stats data using (claim[int(column("y"))] = strcol("statement"), k = strcol("kind"), g = column("grade"), \
    (k eq "baseline" ? (variant[int(column("x"))] = strcol("variant")) : ""), v = k eq "verdict", pass = pass + (v && g == 0), \
    open = open + (v && g == 1), fail = fail + (v && g == 2), 0) nooutput
# a statement of more than 54 letters takes two lines, parted at the last blank of its first half and a little more
blank(s, k) = k < 2 || s[k:k] eq " " ? k : blank(s, k - 1)
part(s, k) = s[1:k - 1]."\n".s[k + 1:strlen(s)]
short(s) = strlen(s) > 130 ? s[1:129]."…" : s
wrap(s) = strlen(s) > 54 ? part(s, blank(s, int(strlen(s)/2) + 5)) : s
headline = "The claims of the paper"
subline = sprintf("%d pass, %d not testable, %d fail. First cell: variants in which a claim holds; thick frame: the variant that gives the verdict.", pass, open, fail)
note = "Percentages: share of parameter samples in which it holds; yes, no: not sampled."
is(grade, v) = column("grade") == grade ? v : NaN
named(v) = strcol("kind") eq "named" ? v : NaN
other(v) = strcol("kind") ne "named" ? v : NaN
ink(v) = int(v) == 2 ? 0xffffff : 0x000000
array grade_name[3] = ["pass", "not testable", "fail"]
array grade_colour[3] = ["#d5e8f3", "#f4f4f4", "#b0401a"]

do for [format in formats] {
    high = 290 + 44*rows
    page_wide = 1200; page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font 'DejaVu Sans,19' linewidth 2 enhanced } \
    else { set terminal svg size page_wide,page_high font 'DejaVu Sans,13' linewidth 1.2 enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format); fine = format eq "png" ? ",11" : ",8"
    set multiplot
    unset grid
    set lmargin at screen 0.30; set rmargin at screen 0.99
    set tmargin at screen 1.0 - 106.0/high; set bmargin at screen 170.0/high
    set xrange [-1.3:columns + 0.55]; set yrange [rows + 0.5:0.5]
    unset border
    unset xtics; unset ytics
    do for [i=1:columns] { set label 100+i variant[i] at first i,graph 0 right rotate by 35 noenhanced font tiny offset 0,-0.6 }
    do for [i=1:rows] {
        set label 200+i wrap(short(claim[i])) at first -1.3,i right noenhanced font tiny offset -0.4,(strlen(claim[i]) > 54 ? 0.3 : 0)
    }
    set label 97 headline at screen 0.5,1.0 - 16.0/high center noenhanced font (format eq "png" ? ",23" : ",16")
    set label 98 subline at screen 0.5,1.0 - 40.0/high center noenhanced font tiny textcolor rgb grey
    set label 96 note at screen 0.5,1.0 - 58.0/high center noenhanced font tiny textcolor rgb grey
    set label 99 provenance at screen 0.99,0.012 right noenhanced font fine textcolor rgb grey
    set key at screen 0.5,(1.0 - 80.0/high) center top horizontal maxrows 1 samplen 1.2 width 1
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
