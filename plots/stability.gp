# stability.gp - a table of marks: rows are cases, columns algorithms; in each cell the power of ten of the error.
data = figure.".csv"
stats data using "x" nooutput
columns = int(STATS_max)
stats data using "y" nooutput
cases = int(STATS_max)
array case[cases]; array algorithm[columns]
ok = 0; degraded = 0; failed = 0
stats data using (case[int(column("y"))] = strcol("subject"), algorithm[int(column("x"))] = strcol("algorithm"), \
    g = column("grade"), ok = ok + (g == 0), degraded = degraded + (g == 1), failed = failed + (g == 2), 0) nooutput
headline = "Stability: extreme and stiff cases against algorithms"
subline = sprintf("%d ok, %d degraded, %d failed; numbers: power of ten of the relative error, – unknown", ok, degraded, failed)
is(grade, v) = column("grade") == grade ? v : NaN
array grade_name[3] = ["ok", "degraded", "failed"]
array grade_colour[3] = ["#d5e8f3", "#f0c060", "#b0401a"]

do for [format in formats] {
    high = 215 + 22*cases
    eval page(format, 860, high); tiny = small(format)
    set multiplot
    unset grid
    set lmargin at screen 0.30; set rmargin at screen 0.985
    set tmargin at screen 1.0 - 100.0/high; set bmargin at screen 100.0/high
    set xrange [0.5:columns + 0.5]; set yrange [cases + 0.5:0.5]
    unset border
    set xtics scale 0 rotate by 35 right noenhanced font tiny; set ytics scale 0 noenhanced font tiny
    set xtics (0); set ytics (0)
    do for [i=1:columns] { set xtics add (algorithm[i] i) }
    do for [i=1:cases] { set ytics add (case[i] i) }
    eval title_at(format, 1.0 - 16.0/high); set label 98 subline at screen 0.5,(1.0 - 42.0/high) center noenhanced textcolor rgb grey; eval foot(format)
    set key at screen 0.5,(1.0 - 72.0/high) center top horizontal maxrows 1 samplen 1.2 width 1
    plot for [j=0:2] data using (is(j, column("x"))):"y":(0.47):(0.44) with boxxyerror linewidth 0.3 \
            fillcolor rgb grade_colour[j+1] title grade_name[j+1], \
         data using (is(2, column("x"))):"y":(stringcolumn("decade")) with labels \
            font tiny textcolor rgb "#ffffff", \
         data using (column("grade") < 2 ? column("x") : NaN):"y":(stringcolumn("decade")) \
            with labels font tiny textcolor rgb "#000000"
    unset multiplot
    unset output
}
