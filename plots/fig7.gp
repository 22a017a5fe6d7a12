# fig7.gp - solvers of the block tridiagonal system: left over the best serial one, right over conventional PCR.
data = figure.".csv"
stats data using "panel" nooutput
panels = int(STATS_max)
stats data using "series" nooutput
last = int(STATS_max)
stats data using "P" nooutput
pmin = STATS_min; pmax = STATS_max
array size_name[panels]; array method[last]
stats data using (size_name[int(column("panel"))] = strcol("size"), method[int(column("series"))] = strcol("method"), \
    headline = "Block tridiagonal solvers (stage CFA[2]) on ".strcol("machine"), \
    subline = strcol("formulation")." formulation, network level ".strcol("level"), 0) nooutput
of(p, k, v) = column("panel") == p && column("series") == k ? v : NaN
# a seventh method, the serial one, is black and hollow
ink(k) = k > 6 ? "#000000" : colour[k]
symbol(k) = k > 6 ? hollow[turn(k + 1)] : point[k]
array over[2] = ["over the best serial solver", "over conventional PCR"]
values = "over_serial over_conventional"

set xrange [pmin*0.9:pmax*1.12]
do for [format in formats] {
    high = 164 + 240*panels
    page_wide = 800; page_high = int(high)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    # the legend, in a frame as wide as the page
    set lmargin at screen 0.05; set rmargin at screen 0.99; set tmargin at screen 0.9; set bmargin at screen 0.2
    unset border; unset tics; unset logscale; set yrange [0:1]
    set label 97 headline at screen 0.5,1.0 - 18.0/high center noenhanced font large(format)
    set label 98 subline at screen 0.5,1.0 - 44.0/high center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.53,(1.0 - 62.0/high) center top horizontal maxrows 2 samplen 3 width -1
    plot NaN, for [k=1:last] keyentry with linespoints linewidth 1.8 dashtype dash[turn(k)] pointtype symbol(k) pointsize 0.8 \
            linecolor rgb ink(k) title method[k]
    unset key; unset label 97; unset label 98; unset label 99
    set border 3
    set logscale x 2
    set xtics nomirror out scale 0.6; set ytics nomirror out scale 0.6 autofreq
    set xtics (2, 4, 8, 16, 32, 64, 128, 256, 512, 1024) offset 0,tick_lift(format)
    do for [p=1:panels] { do for [side=1:2] {
        set lmargin at screen (side == 1 ? 0.115 : 0.6); set rmargin at screen (side == 1 ? 0.5 : 0.985)
        set tmargin at screen 1.0 - (126.0 + 240*(p - 1) + 18)/high
        set bmargin at screen 1.0 - (126.0 + 240*p - 42)/high
        if (side == 1) { set logscale y 2; set yrange [*:*]; set ylabel "speedup"; set ytics ("1/64" 1.0/64, "1/32" 1.0/32, "1/16" 1.0/16, "1/8" 1.0/8, "1/4" 0.25, "1/2" 0.5, 1, 2, 4, 8, 16, 32, 64, 128, 256) } else { unset logscale y; set yrange [0:*]; set ylabel "factor"; set ytics autofreq }
        set xlabel (p == panels ? "number of processors P" : "") offset 0,name_lift(format)
        set title size_name[p].", ".over[side] noenhanced offset 0,-0.7
        plot 1 with lines linewidth 0.8 linecolor rgb grey, \
             for [k=1:last] data using "P":(of(p, k, column(word(values, side)))) with linespoints linewidth 1.8 \
                dashtype dash[turn(k)] pointtype symbol(k) pointsize 0.8 linecolor rgb ink(k)
    } }
    unset multiplot
    unset output
}
