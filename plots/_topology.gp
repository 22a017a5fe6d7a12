# _topology.gp - a network: routers as points in the colour of their half, cables as lines; those that the bisection cuts are red.
data = figure.".csv"; about = figure.".about.csv"; lines = figure.".lines.csv"
stats about using (headline = strcol("title"), subline = strcol("subtitle"), every = int(column("every")), \
    routers = int(column("routers")), halves = int(column("halves")), 0) nooutput
drawn = 0; cuts = 0
stats lines using (drawn = drawn + 1, cuts = cuts + (column("cut") > 0), 0) nooutput
note = every > 1 ? sprintf("cables of every %d. router are drawn", every) : ""
half_colour(k) = k == 2 ? 0x909090 : k == 1 ? 0xd9a21b : 0x0f4c9c
size_of(n) = n <= 64 ? 1.5 : n <= 256 ? 1.0 : n <= 1024 ? 0.6 : 0.35
width_of(n) = n <= 300 ? 1.1 : n <= 1500 ? 0.7 : 0.4
unset border; unset tics; unset grid
set xrange [-1.2:1.2]; set yrange [-1.2:1.2]
of(k) = drawn > 0 ? (column("cut") == k ? column("x") : NaN) : NaN
do for [format in formats] {
    page_wide = 780; page_high = 870
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 2 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set lmargin at screen 0.02; set rmargin at screen 0.98; set bmargin at screen 0.035; set tmargin at screen 0.90
    set label 97 headline at screen 0.5,0.975 center noenhanced font large(format)
    set label 98 subline at screen 0.5,0.948 center noenhanced textcolor rgb grey
    set label 96 note at screen 0.02,0.014 left noenhanced font least(format) textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.014 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    set key at screen 0.5,0.925 center horizontal maxrows 1 samplen 1.6 width 1
    if (drawn > 0) {
        plot lines using (of(0)):(column("y")):(column("dx")):(column("dy")) with vectors nohead linewidth width_of(drawn) linecolor rgb "#a8b4c0", \
            lines using (of(1)):(column("y")):(column("dx")):(column("dy")) with vectors nohead linewidth width_of(drawn) linecolor rgb "#c43c10", \
            data using (column("x")):(column("y")):(half_colour(column("kind"))) with points pointtype 7 pointsize size_of(routers) linecolor rgb variable, \
            for [i=1:(cuts > 0 ? 1 : 0)] keyentry with lines linewidth 2 linecolor rgb "#c43c10" title "cables between two halves of the nodes"
    } else {
        plot data using (column("x")):(column("y")):(half_colour(column("kind"))) with points pointtype 7 pointsize size_of(routers) linecolor rgb variable
    }
    unset label 96; unset label 97; unset label 98; unset label 99
    unset output
}
