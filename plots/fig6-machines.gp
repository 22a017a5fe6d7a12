# fig6-machines.gp - speedup against n = P on four machines, one panel each, with Amdahl's curves.
data = figure.".csv"
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmin = STATS_min; pmax = STATS_max
stats data using "speedup" nooutput
smin = STATS_min
array name[last]; array machine[4] = ["", "", "", ""]
stats data using (name[int(column("series"))] = strcol("baseline"), \
    machine[int(column("panel"))] = strcol("machine").", ".strcol("level"), \
    headline = "Speedup of the complete dynamics, n = P, on four machines", \
    subline = strcol("formulation")." formulation, ".strcol("operators")." operators", 0) nooutput
amdahl(f, p) = 1.0/((1.0 - f) + f/p)
fractions = "0.70 0.80 0.90 0.95 0.97 0.98"
has_band = name[1] eq "fastest serial"
first = has_band ? 2 : 1
of(m, k, v) = column("panel") == m && column("series") == k ? v : NaN
ymin = 2**floor(log(smin)/log(2)); if (ymin > 0.5) { ymin = 0.5 }
rows = ceil((last + 2)/2.0)

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
    set key at screen 0.53,0.935 center top horizontal maxrows rows samplen 3 width -4
    plot NaN, keyentry with lines linewidth 0.8 linecolor rgb pale title "Amdahl f = 0.70 … 0.98", \
         keyentry with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000" title "ideal S = P", \
         keyentry with lines linewidth 6 linecolor rgb (has_band ? band : "#ffffff") title (has_band ? "over ".name[1] : ""), \
         for [k=first:last] keyentry with linespoints linewidth 1.8 dashtype dash[k-first+1] pointtype point[k-first+1] \
            pointsize 0.9 linecolor rgb colour[k-first+1] title "over ".name[k]
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
        set tmargin at screen (m <= 2 ? 0.785 : 0.41); set bmargin at screen (m <= 2 ? 0.485 : 0.115)
        set ylabel (left ? "speedup S" : "")
        set xlabel (m > 2 ? "n = P" : "")
        set title (machine[m] eq "" ? "(no runs)" : machine[m]) noenhanced offset 0,-0.7
        plot for [i=1:words(fractions)] amdahl(real(word(fractions, i)), x) with lines linewidth 0.8 linecolor rgb pale, \
             x with lines linewidth 1.2 dashtype 3 linecolor rgb "#000000", \
             1 with lines linewidth 0.6 linecolor rgb grey, \
             data using "P":(has_band ? of(m, 1, column("speedup")) : NaN) with lines linewidth 6 linecolor rgb band, \
             for [k=first:last] data using "P":(of(m, k, column("speedup"))) with linespoints linewidth 1.6 \
                dashtype dash[k-first+1] pointtype point[k-first+1] pointsize 0.7 linecolor rgb colour[k-first+1]
    }
    unset multiplot
    unset output
}
