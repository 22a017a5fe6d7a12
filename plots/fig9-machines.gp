# fig9-machines.gp - speedup for several numbers of bodies per processor on four machines, one panel each.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmin = STATS_min; pmax = STATS_max
stats data using "speedup" nooutput
smin = STATS_min
array ratio[last]; array machine[4] = ["", "", "", ""]
stats data using (ratio[int(column("series"))] = column("bodies_per_processor"), \
    machine[int(column("panel"))] = strcol("machine").", ".strcol("level"), \
    headline = "Speedup of the complete dynamics with n/P bodies per processor, on four machines", \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators, over the parallel code on one processor", 0) nooutput
of(m, k, v) = column("panel") == m && column("series") == k ? v : NaN
ymin = 2**floor(log(smin)/log(2)); if (ymin > 0.5) { ymin = 0.5 }

set samples 200
do for [format in formats] {
    page_wide = 800; page_high = 800
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1.2 enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # the legend, in a frame as wide as the page
    set lmargin at screen 0.05; set rmargin at screen 0.99; set tmargin at screen 0.9; set bmargin at screen 0.2
    unset border; unset tics; unset logscale; set xrange [0:1]; set yrange [0:1]
    set label 97 headline at screen 0.5,0.98 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.948 center noenhanced textcolor rgb grey
    set label 99 provenance at screen 0.99,0.012 right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.53,0.935 center top horizontal maxrows 2 samplen 3 width -1
    plot NaN, keyentry with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P", \
         for [k=1:last] keyentry with linespoints linewidth 1.8 dashtype dash[k] pointtype point[k] pointsize 0.9 \
            linecolor rgb colour[k] title sprintf("n/P = %d", ratio[k])
    unset key; unset label 97; unset label 98; unset label 99
    set border 3
    set logscale x 2; set logscale y 2
    set xrange [pmin*0.9:pmax*1.12]
    set yrange [ymin:pmax*1.1]
    set xtics nomirror out scale 0.6; set ytics nomirror out scale 0.6
    set xtics (2, 4, 8, 16, 32, 64, 128, 256, 512, 1024)
    set ytics ("1/1024" 1.0/1024, "1/256" 1.0/256, "1/64" 1.0/64, "1/16" 1.0/16, "1/4" 0.25, 1, 4, 16, 64, 256, 1024)
    do for [m=1:4] {
        left = m % 2 == 1
        set lmargin at screen (left ? 0.1 : 0.605); set rmargin at screen (left ? 0.485 : 0.985)
        set tmargin at screen (m <= 2 ? 0.82 : 0.41); set bmargin at screen (m <= 2 ? 0.49 : 0.115)
        set ylabel (left ? "speedup S" : "")
        set xlabel (m > 2 ? "number of processors P" : "")
        set title (machine[m] eq "" ? "(no runs)" : machine[m]) noenhanced offset 0,-0.7
        plot x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000", \
             1 with lines linewidth 0.6 linecolor rgb grey, \
             for [k=1:last] data using "P":(of(m, k, column("speedup"))) with linespoints linewidth 1.6 \
                dashtype dash[k] pointtype point[k] pointsize 0.7 linecolor rgb colour[k]
    }
    unset multiplot
    unset output
}
