# linkmap.gp - heat map of link load on a mesh or torus: one panel a direction, one cell a router, its outgoing link.
data = figure.".csv"
stats data using "panel" nooutput
panels = int(STATS_max)
stats data using "x" nooutput
wide = STATS_max + 1
stats data using "y" nooutput
high = STATS_max + 1
stats data using "busy_share" nooutput
top = STATS_max > 0 ? STATS_max : 1
array direction[panels]
do for [i=1:panels] { direction[i] = "" }
stats data using (direction[int(column("panel"))] = strcol("direction"), \
    headline = sprintf("Link load of %s on %s, P = %d", strcol("kernel"), strcol("machine"), column("P")), \
    subline = sprintf("%s %s, network level %s; each cell a router's outgoing link", strcol("topology"), strcol("dims"), strcol("level")), 0) nooutput
of(p, v) = column("panel") == p ? v : NaN
rows = int((panels + 1)/2)
set palette defined (0 "#f7fbff", 0.25 "#c9dcf0", 0.5 "#7fb0dc", 0.75 "#2f6fb7", 1 "#0b2f66")
set cbrange [0:top]
set xrange [-0.5:wide - 0.5]; set yrange [-0.5:high - 0.5]
set xtics autofreq; set ytics autofreq
unset grid
set style fill solid 1.0 noborder
do for [format in formats] {
    tall = 140 + 190*rows
    page_wide = 860; page_high = int(tall)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set label 97 headline at screen 0.5,1.0 - 20.0/tall center noenhanced font large(format)
    set label 98 subline at screen 0.5,1.0 - 20.0/tall - 0.032 center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,(0.012 + foot_lift(provenance, page_wide)*1.0/page_high) right noenhanced font least(format) textcolor rgb grey
    do for [p=1:panels] {
        column_of = int((p - 1) % 2)
        row_of = int((p - 1)/2)
        set lmargin at screen (column_of == 0 ? 0.08 : 0.49); set rmargin at screen (column_of == 0 ? 0.43 : 0.84)
        set tmargin at screen 1.0 - (78.0 + 190*row_of + 12)/tall
        set bmargin at screen 1.0 - (78.0 + 190*row_of + 150)/tall
        set title direction[p] noenhanced offset 0,-0.8
        set xtics offset 0,tick_lift(format); set xlabel (row_of == rows - 1 ? "x" : "") offset 0,name_lift(format)
        set ylabel (column_of == 0 ? (high > wide ? "other coordinates" : "y") : "") offset 0.6,0
        if (p == 2) {
            set colorbox user origin screen 0.86,(0.2) size screen 0.022,0.6
            set cblabel "share of the run in use" offset 0.4,0
            set format cb "%.2g"
        } else { unset colorbox }
        plot data using (of(p, column("x"))):"y":(0.47):(0.45):"busy_share" with boxxyerror linewidth 0 fillcolor palette
        unset label 97; unset label 98; unset label 99
    }
    unset multiplot
    unset output
}
