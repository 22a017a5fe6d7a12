# _lines.gp - curves of any column over any other: panels, logarithmic axes and texts are as the data says.
data = figure.".csv"; about = figure.".about.csv"
bands = ""; xlabel = ""; vlabel = ""
stats about using (headline = strcol("title"), subline = strcol("subtitle"), bands = strcol("bands"), \
    xlabel = strcol("xlabel"), vlabel = strcol("vlabel"), xscale = column("xscale"), vscale = column("vscale"), \
    xlog = int(column("xlog")), vlog = int(column("vlog")), panels = int(column("panels")), curves = int(column("curves")), \
    nx = int(column("nx")), band = int(column("band")), x_number = int(column("x_number")), longest = column("longest"), 0) nooutput
array name[curves]; array panel_name[panels]
stats data using (name[int(column("series"))] = strcol("curve"), panel_name[int(column("panel"))] = strcol("panel_name"), 0) nooutput
at_x(i, v) = x_number ? v*xscale : i
of(m, k, v) = column("panel") == m && column("series") == k ? v : NaN
stats data using (column("value")*vscale) nooutput
vmin = STATS_min; vmax = STATS_max
stats data using (column("low")*vscale) nooutput
if (band) { vmin = STATS_min < vmin ? STATS_min : vmin }
stats data using (column("high")*vscale) nooutput
if (band) { vmax = STATS_max > vmax ? STATS_max : vmax }
stats data using (at_x(column("xi"), column("x"))) nooutput
xmin = STATS_min; xmax = STATS_max
left_px = axis_px(vlog > 0 ? letters_log(vlog, vmin, vmax) : letters_even(vmin, vmax))
# no legend for a single curve without a name
legend = curves > 1 || strlen(name[1]) > 0
columns = panels == 1 ? 1 : (panels <= 4 ? 2 : 3)
rows = ceil(1.0*panels/columns)
legend_columns = longest > 44 ? 1 : (longest > 22 ? 2 : 4)
legend_rows = legend ? ceil(1.0*curves/legend_columns) : 0
wide = columns == 1 ? 800.0 : 1100.0
upper = 56 + (strlen(bands) > 0 ? 18 : 0) + 20*legend_rows + (panels > 1 ? 26 : 8)
panel_high = columns == 1 ? 440.0 : 320.0
high = upper + rows*panel_high + 26 + foot_more(provenance, wide)
at_y(px) = 1.0 - px/high
# a little room beyond the first and the last point
pad_low(v, log) = log > 0 ? v/1.12 : v
pad_high(v, log) = log > 0 ? v*1.12 : v

do for [format in formats] {
    if (format eq "png") { set terminal pngcairo size int(2*wide),int(2*high) font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size int(wide),int(high) font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    set multiplot
    set lmargin at screen 0.03; set rmargin at screen 0.985
    set tmargin at screen at_y(56 + (strlen(bands) > 0 ? 18 : 0)); set bmargin at screen at_y(upper)
    unset border; unset tics; unset grid; unset logscale; set xrange [0:1]; set yrange [0:1]
    set label 96 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 97 subline at screen 0.5,at_y(42) center noenhanced textcolor rgb grey
    set label 98 bands at screen 0.5,at_y(60) center noenhanced font small(format) textcolor rgb grey
    set label 99 foot(provenance, wide) at screen 0.99,at_y(high - foot_high(provenance, wide)) right noenhanced font least(format) textcolor rgb grey
    if (legend) { set key at screen 0.5,at_y(54 + (strlen(bands) > 0 ? 18 : 0)) center top horizontal maxcols legend_columns samplen 3 noenhanced } \
    else { unset key }
    plot NaN notitle, for [k=1:curves] keyentry with linespoints linewidth 1.8 dashtype dash[turn(k)] pointtype point[turn(k)] pointsize 0.9 \
        linecolor rgb colour[turn(k)] title name[k]
    unset key; unset label 96; unset label 97; unset label 98; unset label 99
    set border 3 linewidth 0.8; set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
    if (xlog > 0) { set logscale x xlog }
    if (vlog > 0) { set logscale y vlog }
    set xrange [(xlog > 0 || !x_number ? pad_low(xmin, xlog) : xmin - 0.02*(xmax - xmin)):(xlog > 0 ? pad_high(xmax, xlog) : xmax + 0.02*(xmax - xmin))]
    if (!x_number) { set xrange [0.5:nx + 0.5] }
    set yrange [(vlog > 0 ? pad_low(vmin, vlog) : (vmin > 0 ? 0 : vmin - 0.05*(vmax - vmin))):(vlog > 0 ? pad_high(vmax, vlog) : vmax + 0.05*(vmax - vmin) + (vmax == vmin))]
    set format x "%.6g"; set format y "%.6g"
    set xtics nomirror out scale 0.6 autofreq offset 0,tick_lift(format); set ytics nomirror out scale 0.6 autofreq
    if (xlog > 0 && x_number) { # so many labels as have room
        powers = ceil(log(xmax/xmin)/log(xlog)/(columns == 1 ? 9.0 : 4.0))
        if (powers > 1) { set xtics xlog**floor(log(xmin)/log(xlog)),xlog**powers }
        if (xlog == 2 && xmax >= 1e5) {
            set xtics ()
            do for [k=floor(log(xmin)/log(2) + 1e-9):ceil(log(xmax)/log(2)):(powers > 1 ? powers : 1)] { set xtics add (ki(2.0**k) 2.0**k) }
        }
    }
    do for [m=1:panels] {
        c = (m - 1) % columns; r = (m - 1)/columns
        left = left_px/wide + c*(0.985 - 0.02)/columns
        set lmargin at screen left
        set rmargin at screen (columns == 1 ? 0.975 : left + 0.985/columns - 0.075)
        set tmargin at screen at_y(upper + r*panel_high + 6); set bmargin at screen at_y(upper + (r + 1)*panel_high - (panels > 1 ? 82 : 48))
        set xlabel xlabel noenhanced offset 0,name_lift(format)
        set ylabel (c == 0 ? vlabel : "") noenhanced
        if (panels > 1) { set title panel_name[m] noenhanced offset 0,-0.6 }
        plot for [k=1:curves] data using (column("rows") > 1 ? at_x(column("xi"), column("x")) : NaN):(of(m, k, column("low")*vscale)):(of(m, k, column("high")*vscale)) \
                with filledcurves fillcolor rgb colour[turn(k)] fillstyle transparent solid 0.15 noborder notitle, \
             for [k=1:curves] data using (column("rows") > 1 ? at_x(column("xi"), column("x")) : NaN):(of(m, k, column("value")*vscale)):(column("low")*vscale):(column("high")*vscale) \
                with yerrorbars linewidth 1 pointsize 0 linecolor rgb colour[turn(k)] notitle, \
             for [k=1:curves] data using (at_x(column("xi"), column("x"))):(of(m, k, column("value")*vscale)) with linespoints linewidth 1.8 \
                dashtype dash[turn(k)] pointtype point[turn(k)] pointsize (nx > 40 ? 0.4 : 0.9) linecolor rgb colour[turn(k)] notitle, \
             figure.".x.csv" using "xi":(vmin):xticlabels(strcol("x_text")) with points pointsize 0 notitle
    }
    unset multiplot
    unset output
}
