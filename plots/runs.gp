# runs.gp - the time of every run of a kernel: small panels of six curves with the same axes.
data = figure.".csv"
stats data using "panel" nooutput
panels = int(STATS_max)
array curve[6*panels]; array title_of[panels]; array last[panels]
do for [i=1:6*panels] { curve[i] = "" }
do for [i=1:panels] { last[i] = 0 }
low = 1e300; high = 0; xlow = 1e300; xhigh = 0; zero = 0; longest = 0
stats data using (p = int(column("panel")), k = int(column("series")), curve[6*p - 6 + k] = strcol("curve"), title_of[p] = strcol("title"), \
    last[p] = k > last[p] ? k : last[p], u = column("us"), low = u < low ? u : low, w = column("most_us"), high = w > high ? w : high, \
    x = column("x"), zero = zero || x == 0, xlow = x > 0 && x < xlow ? x : xlow, xhigh = x > xhigh ? x : xhigh, \
    longest = strlen(strcol("curve")) > longest ? strlen(strcol("curve")) : longest, \
    headline = "Every run of ".strcol("kernel").(strcol("machine") eq "" ? "" : " on ".strcol("machine")), \
    subline = sprintf("%d run%s, %d curve%s", column("all_runs"), column("all_runs") == 1 ? "" : "s", column("curves"), column("curves") == 1 ? "" : "s").(column("left_out") > 0 ? sprintf("; the %d with fewest points are left out", column("left_out")) : ""), \
    axis = strcol("axis"), unit = strcol("unit"), square = column("square") == 1, measured = column("measured") == 1, 0) nooutput
if (xlow > xhigh) { xlow = 1; xhigh = 1 }
if (!(high > 0)) { low = 0; high = 1 }
axis_name = axis eq "ranks" ? (square ? "ranks P = n" : "ranks P") : axis eq "model.n" ? "bodies n" : axis.(unit eq "" ? "" : " [".unit."]")
logarithmic = xhigh/xlow >= 6; steep = low > 0 && high/low > 8
# on a logarithmic axis 0 stands left of the least number
none = xlow/4
at(x) = x == 0 && logarithmic ? none : x
of(p, k, v) = column("panel") == p && column("series") == k ? v : NaN
decades = steep ? log10(high/low) : 0
unit_of_time = high < 1e3 || decades > 3 ? "µs" : high < 1e6 ? "ms" : "s"
scale = high < 1e3 || decades > 3 ? 1.0 : high < 1e6 ? 1e-3 : 1e-6
across = panels > 1 ? 2 : 1; down = int((panels + across - 1)/across)
most = 1; do for [i=1:panels] { if (last[i] > most) { most = last[i] } }
short(s, n) = strlen(s) > n ? s[1:n-1]."…" : s
# the names of the curves stand below their panel
key_high = 18*most; panel_high = panels > 1 ? 230 : 330; row_high = panel_high + 78 + key_high
wide = across > 1 ? 1000.0 : 800.0; high_px = 84.0 + row_high*down + 20
left_px = axis_px(steep ? (decades > 3 ? 4 : letters_log(10, scale*low/1.3, scale*high*1.3)) : letters_even(0, scale*high*1.08))
width = (wide - 30 - left_px - (across > 1 ? 80 : 0))/across
at_x(px) = px/wide; at_y(px) = 1.0 - px/high_px

do for [format in formats] {
    page_wide = int(wide); page_high = int(high_px)
    if (format eq "png") { set terminal pngcairo size 2*page_wide,2*page_high font png_font linewidth 2 pointscale 3.1 dashlength 0.75 enhanced } \
    else { set terminal svg size page_wide,page_high font svg_font linewidth 1 background "#ffffff" enhanced }
    set output figure.".".format; unset title; unset xlabel; unset ylabel
    tiny = small(format)
    set multiplot
    set label 97 headline at screen 0.5,at_y(20) center noenhanced font large(format)
    set label 98 subline at screen 0.5,at_y(44) center noenhanced textcolor rgb grey
    set label 99 foot(provenance, page_wide) at screen 0.99,at_y(high_px - 9 - foot_lift(provenance, page_wide)) right noenhanced font least(format) textcolor rgb grey
    if (logarithmic) { set logscale x 2; set xrange [(zero ? none/1.3 : xlow/1.15):xhigh*1.15] } \
    else { set xrange [xlow - 0.05*(xhigh - xlow) - (xhigh > xlow ? 0 : 1):xhigh + 0.05*(xhigh - xlow) + (xhigh > xlow ? 0 : 1)] }
    if (steep) { set logscale y; set yrange [scale*low/1.3:scale*high*1.3] } else { set yrange [0:scale*high*1.08] }
    if (decades > 3) { set format y "10^{%T}" } else { set format y "%g" }
    if (steep && decades <= 3) { # a decade may hold one label alone
        set ytics (1)
        do for [i=-7:7] { set ytics add (sprintf("%g", 10.0**i) 10.0**i, sprintf("%g", 2*10.0**i) 2*10.0**i, sprintf("%g", 5*10.0**i) 5*10.0**i) }
    }
    set xtics autofreq offset 0,tick_lift(format)
    if (logarithmic) {
        step = 2**ceil(log(xhigh/xlow)/log(2)/(across > 1 ? 6.0 : 9.0))
        set xtics xlow,step,xhigh*1.1 offset 0,tick_lift(format)
        # sizes in bytes have shorter names
        if (unit eq "B") { set xtics ("1" 1, "8" 8, "64" 64, "512" 512, "4 Ki" 4096, "32 Ki" 32768, "256 Ki" 262144, "2 Mi" 2097152, "16 Mi" 16777216) }
        if (zero) { set xtics add ("0" none) }
    }
    do for [p=1:panels] {
        c = (p - 1) % across; r = int((p - 1)/across)
        left = left_px + c*(width + 80)
        set lmargin at screen at_x(left); set rmargin at screen at_x(left + width)
        set tmargin at screen at_y(84 + r*row_high); set bmargin at screen at_y(84 + r*row_high + panel_high)
        set title (panels > 1 ? title_of[p] : "") noenhanced offset 0,-0.7
        set xlabel axis_name noenhanced offset 0,name_lift(format)
        set ylabel (c == 0 ? "time [".unit_of_time."]" : "")
        set key at screen at_x(left - 12),at_y(84 + r*row_high + panel_high + 42) left top vertical maxrows 6 samplen 3 font tiny
        plot for [k=1:last[p]] data using (at(column("x"))):(of(p, k, scale*column("us"))) with lines linewidth 1.6 dashtype dash[k] linecolor rgb colour[k], \
             for [k=1:last[p]] data using (at(column("x"))):(near(of(p, k, scale*column("us")))):(sprintf("%g: %.4g µs", column("x"), column("us"))) \
                with labels hypertext point pointtype point[k] pointsize 0.7 linecolor rgb colour[k], \
             for [k=1:last[p]] keyentry with linespoints linewidth 1.6 dashtype dash[k] pointtype point[k] pointsize 0.7 linecolor rgb colour[k] \
                title short(curve[6*p - 6 + k], across > 1 ? 62 : 100)
        unset label 97; unset label 98; unset label 99
    }
    unset multiplot
    unset output
}
