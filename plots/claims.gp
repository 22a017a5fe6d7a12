# claims.gp - a table of marks: rows are claims, columns their variants; in each cell the share of samples that pass.
data = figure.".csv"
stats data using "x" nooutput
columns = int(STATS_max)
stats data using "y" nooutput
claims = int(STATS_max)
array claim[claims]; array variant[columns]
pass = 0; open = 0; fail = 0
stats data using (claim[int(column("y"))] = strcol("id").": ".strcol("statement"), \
    variant[int(column("x"))] = strcol("variant"), g = column("grade"), v = strcol("variant") eq "verdict", pass = pass + (v && g == 0), open = open + (v && g == 1), \
    fail = fail + (v && g == 2), 0) nooutput
# a statement of more than 72 letters takes two lines, parted at the last blank of its first half and a little more
blank(s, k) = k < 2 || s[k:k] eq " " ? k : blank(s, k - 1)
part(s, k) = s[1:k - 1]."\n".s[k + 1:strlen(s)]
wrap(s) = strlen(s) > 72 ? part(s, blank(s, int(strlen(s)/2) + 5)) : s
headline = "The claims of the paper"
subline = sprintf("%d pass, %d not testable, %d fail; percentages: share of parameter samples in which a claim holds", pass, open, fail)
is(grade, v) = column("grade") == grade ? v : NaN
array grade_name[3] = ["pass", "not testable", "fail"]
array grade_colour[3] = ["#d5e8f3", "#f4f4f4", "#b0401a"]

do for [format in formats] {
    high = 300 + 32*claims
    eval page(format, 1200, high); tiny = small(format)
    set multiplot
    unset grid
    set lmargin at screen 0.40; set rmargin at screen 0.985
    set tmargin at screen 1.0 - 76.0/high; set bmargin at screen 200.0/high
    set xrange [0.5:columns + 0.5]; set yrange [claims + 0.5:0.5]
    unset border
    set xtics scale 0 rotate by 35 right noenhanced font tiny; set ytics scale 0 noenhanced font tiny
    set xtics (0); set ytics (0)
    do for [i=1:columns] { set xtics add (variant[i] i) }
    do for [i=1:claims] { set ytics add (wrap(claim[i]) i) }
    eval title_at(format, 1.0 - 16.0/high); eval foot(format)
    set key at screen 0.5,(1.0 - 50.0/high) center top horizontal maxrows 1 samplen 1.2 width 1
    plot for [j=0:2] data using (is(j, column("x"))):"y":(0.47):(0.44) with boxxyerror linewidth 0.3 \
            fillcolor rgb grade_colour[j+1] title grade_name[j+1], \
         data using (is(2, column("x"))):"y":(stringcolumn("mark")) with labels font tiny textcolor rgb "#ffffff", \
         data using (column("grade") < 2 ? column("x") : NaN):"y":(stringcolumn("mark")) with labels font tiny \
            textcolor rgb "#000000"
    unset multiplot
    unset output
}
