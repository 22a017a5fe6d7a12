# _bars.gp - bars of any column for each value of another, side by side by curve: the numbers stand at their ends.
data = figure.".csv"; about = figure.".about.csv"
bands = ""; xlabel = ""; vlabel = ""
stats about using (headline = strcol("title"), subline = strcol("subtitle"), bands = strcol("bands"), \
    xlabel = strcol("xlabel"), vlabel = strcol("vlabel"), vscale = column("vscale"), \
    vlog = int(column("vlog")), panels = int(column("panels")), curves = int(column("curves")), \
    nx = int(column("nx")), band = int(column("band")), longest = column("longest"), 0) nooutput
array name[curves]; array panel_name[panels]
stats data using (name[int(column("series"))] = strcol("curve"), panel_name[int(column("panel"))] = strcol("panel_name"), 0) nooutput
of(m, k, v) = column("panel") == m && column("series") == k ? v : NaN
stats data using (column("value")*vscale) nooutput
vmin = STATS_min; vmax = STATS_max
stats data using (column("high")*vscale) nooutput
if (band) { vmax = STATS_max > vmax ? STATS_max : vmax }
# a bar begins at zero, or on a logarithmic axis at a power below the least
base = vlog > 0 ? 10**floor(log10(vmin) - 0.0001) : (vmin < 0 ? vmin*1.15 : 0)
top = vlog > 0 ? vmax**1.0*(vmax/base)**0.18 : vmax*1.18
legend = curves > 1 || strlen(name[1]) > 0
legend_columns = longest > 44 ? 1 : (longest > 22 ? 2 : 4)
legend_rows = legend ? ceil(1.0*curves/legend_columns) : 0
# lying bars: names of any length have room on the left
bar_high = curves == 1 ? 22.0 : 16.0
group_high = bar_high*curves + 12
wide = 900.0
upper = 62 + (strlen(bands) > 0 ? 18 : 0) + 20*legend_rows + 10
panel_high = nx*group_high + 62 + (panels > 1 ? 22 : 0)
high = upper + panels*panel_high + 20 + foot_more(provenance, wide)
at_y(px) = 1.0 - px/high
longest_x = 0
stats data using (longest_x = strlen(strcol("x_text")) > longest_x ? strlen(strcol("x_text")) : longest_x, 0) nooutput
left = 0.03 + 0.0082*(longest_x > 52 ? 52 : longest_x) + 0.02
y_of(i, k) = i + (k - 0.5*(curves + 1))*bar_high/group_high

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size int(2*wide),int(2*high) font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size int(wide),int(high) font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set lmargin at screen 0.03; set rmargin at screen 0.985
    set tmargin at screen at_y(56 + (strlen(bands) > 0 ? 18 : 0)); set bmargin at screen at_y(upper)
    unset border; unset tics; unset grid; unset logscale; set xrange [0:1]; set yrange [0:1]
    set label 96 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 97 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 98 bands at screen 0.5,at_y(60) center noenhanced font small(format) textcolor rgb grey
    set label 99 foot(provenance, wide) at screen 0.99,at_y(high - foot_high(provenance, wide)) right noenhanced font least(format) textcolor rgb grey
    if (legend) { set key at screen 0.5,at_y(54 + (strlen(bands) > 0 ? 18 : 0)) center top horizontal maxcols legend_columns samplen 2 noenhanced } \
    else { unset key }
    plot NaN notitle, for [k=1:curves] keyentry with boxes fillcolor rgb colour[turn(k)] title name[k]
    unset key; unset label 96; unset label 97; unset label 98; unset label 99
    set border 3 linewidth 0.8; set grid x linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
    if (vlog > 0) { set logscale x 10 }
    set xrange [base:top]
    set yrange [nx + 0.55:0.45]
    set format x "%.6g"
    set xtics nomirror out scale 0.6 autofreq offset 0,tick_lift(format)
    set lmargin at screen left; set rmargin at screen 0.975
    do for [m=1:panels] {
        set tmargin at screen at_y(upper + (m - 1)*panel_high + (panels > 1 ? 22 : 0)); set bmargin at screen at_y(upper + m*panel_high - 58)
        set xlabel vlabel noenhanced offset 0,name_lift(format)
        if (panels > 1) { set title panel_name[m] noenhanced offset 0,-0.6 }
        set ytics () scale 0
        # what the groups of bars are, above their names
        group_y = at_y(upper + (m - 1)*panel_high + (panels > 1 ? 14 : -8))
        if (6.6*strlen(xlabel) < left*wide - 16) { set label 95 xlabel at screen left - 0.012,group_y right noenhanced font tiny textcolor rgb grey } \
        else { set label 95 xlabel at screen 0.008,group_y left noenhanced font tiny textcolor rgb grey }
        plot for [k=1:curves] data using (of(m, k, column("value")*vscale)):(y_of(column("xi"), k)):(base):(of(m, k, column("value")*vscale)):(y_of(column("xi"), k) - 0.42*bar_high/group_high):(y_of(column("xi"), k) + 0.42*bar_high/group_high) \
                with boxxyerror fillcolor rgb colour[turn(k)] linewidth 0.3 notitle, \
             for [k=1:curves] data using (column("rows") > 1 ? of(m, k, column("value")*vscale) : NaN):(y_of(column("xi"), k)):(column("low")*vscale):(column("high")*vscale) \
                with xerrorbars linewidth 1 pointsize 0 linecolor rgb "#303030" notitle, \
             for [k=1:curves] data using (of(m, k, (column("high") > column("value") ? column("high") : column("value"))*vscale)):(y_of(column("xi"), k)):(sprintf("%.4g", column("value")*vscale)) \
                with labels left offset 0.6,0 noenhanced font tiny notitle, \
             figure.".x.csv" using (base):"xi":yticlabels(strcol("x_text")) with points pointsize 0 notitle
    }
    unset label 95
    unset multiplot
    unset output
}
