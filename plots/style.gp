# style.gp - what all figures share. The variable figure, a file's name, is set before; data is in figure.".csv".
# Texts of a database are read as columns of data files and shown as strings that are not enhanced. None becomes a part of
# a command: nothing in this folder evaluates a text, expands a macro, starts a program or loads a file.
set encoding utf8
set datafile commentschars ""
# who made the numbers: one line of text
provenance = ""
set datafile separator tab
stats figure.".provenance" using (provenance = strcol(1), 0) nooutput
set datafile separator comma
set datafile missing ''
set datafile columnheaders
formats = "png svg"

# A line that is longer than a page of wide pixels goes on, on up to four. Where two are enough the first ends behind the
# first semicolon of the second half, or the first comma; else each behind the last of them that has room, or a blank.
# foot_high is where the first stands above the lower edge, foot_lift how much higher than one alone.
room(wide) = int(wide/5.4)
is_end(s, k) = s[k:k] eq " " && (s[k-1:k-1] eq ";" || s[k-1:k-1] eq "," || s[k-1:k-1] eq "‚")
last_end(s, k) = k < 2 ? 0 : (is_end(s, k) ? k : last_end(s, k - 1))
last_blank(s, k) = k < 2 ? 0 : (s[k:k] eq " " ? k : last_blank(s, k - 1))
half(s) = int(strlen(s)/2)
second(s, mark) = strstrt(s[half(s):*], mark) > 0 ? half(s) + strstrt(s[half(s):*], mark) : 0
fits(k, n) = k > 0 && k <= n
middle(s, n) = strlen(s) > 2*n ? 0 : (fits(second(s, "; "), n) ? second(s, "; ") : (fits(second(s, ", "), n) ? second(s, ", ") : 0))
behind(s, n) = middle(s, n) > 0 ? middle(s, n) : late(s, n)
late(s, n) = last_end(s, n) > n/2 ? last_end(s, n) : (last_blank(s, n) > 0 ? last_blank(s, n) : n)
on(s, wide, more) = strlen(s) <= room(wide) || more == 0 ? s : \
    s[1:behind(s, room(wide))]."\n".on(s[behind(s, room(wide)) + 1:*], wide, more - 1)
further(s, wide, more) = strlen(s) <= room(wide) || more == 0 ? 0 : \
    1 + further(s[behind(s, room(wide)) + 1:*], wide, more - 1)
foot(s, wide) = on(s, wide, 3)
foot_lift(s, wide) = 13*further(s, wide, 3)
foot_high(s, wide) = 9 + foot_lift(s, wide)
# what a foot of more than two lines needs beyond the room that every figure leaves for one
foot_more(s, wide) = foot_lift(s, wide) > 13 ? foot_lift(s, wide) - 13 : 0

# A PNG has twice the pixels of the SVG, and its fonts, lines, symbols and dashes are scaled so that both look alike.
png_font = "DejaVu Sans,19"; svg_font = "DejaVu Sans,13"
large(format) = format eq "png" ? ",23" : ",16"
small(format) = format eq "png" ? ",16" : ",11"
least(format) = format eq "png" ? ",13" : ",9"
# The svg terminal puts labels and names of axes lower than the others do, by this many lines.
tick_lift(format) = format eq "png" ? 0 : 0.55
name_lift(format) = format eq "png" ? 0.3 : 1.1

# Six colours, and no more in a panel. The nearest two differ by 29 units of CIEDE2000; by 16 at least for readers who lack
# one kind of cones. They also differ in lightness, and each comes with a symbol and a dash of its own.
array colour[6] = ["#0f4c9c", "#c43c10", "#2a8a68", "#d9a21b", "#6b2346", "#45b0e0"]
array point[6] = [7, 5, 9, 13, 11, 15]
array hollow[6] = [6, 4, 8, 12, 10, 14]
array dash[6] = [1, 2, 4, 5, 3, 1]
turn(k) = (int(k) - 1) % 6 + 1
# Where a point with a tooltip is not to be drawn: outside of every axis. gnuplot 5.4 breaks down over labels of which the
# only one is no number.
away = 1e300
near(v) = v == v ? v : away
# The fastest serial code is always one of the others: a wide pale band under that one's curve.
band = "#d0d0d0"
grey = "#666666"
pale = "#b8b8b8"

# Where a vertical axis stands [pixels from the left] whose longest number has so many letters: the name of the axis stands
# left of them, and gnuplot leaves out one that has no room. letters_log is for the powers of a base, letters_even for even steps.
wider(a, b) = a > b ? a : b
axis_px(letters) = letters < 4 ? 72.0 : 76 + 9.2*(letters - 4)
power_letters(b, k, last) = k > last ? 1 : wider(strlen(sprintf("%.6g", (1.0*b)**k)), power_letters(b, k + 1, last))
letters_log(b, low, high) = power_letters(b, int(floor(log(low)/log(b))), int(ceil(log(high)/log(b))))
even_letters(size, step, below) = (size >= 1 ? int(floor(log10(size))) + 1 : 1) + (step > 0 && step < 1 ? 1 + int(ceil(-log10(step))) : 0) + below
letters_even(low, high) = even_letters(wider(abs(low), abs(high)), (low > 0 ? high : high - low)/10.0, low < 0)

# A power of two as sizes are written: 512, 8 Ki, 2 Mi. (gnuplot's own %B says "ki".)
ki(v) = v < 1024 ? sprintf("%g", v) : v < 2.0**20 ? sprintf("%g Ki", v/1024) : \
    v < 2.0**30 ? sprintf("%g Mi", v/2.0**20) : v < 2.0**40 ? sprintf("%g Gi", v/2.0**30) : sprintf("%g Ti", v/2.0**40)

# One bar part of a stage: computing dark, waiting light, so that the order shows in grey too.
compute_colour = "#0f4c9c"
send_colour = "#d9a21b"
recv_colour = "#f3e0a6"
wait_colour = "#f6f6f6"
contention_colour = "#c43c10"
# Verdicts: light where it holds, dark where not.
good_colour = "#d8e6f4"; middle_colour = "#f0c368"; bad_colour = "#b0401a"

set border 3 linewidth 0.8
# no blank in front of a number: it would shift the label beside its tick
set format "%g"
set tics nomirror out scale 0.6
set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
set key noautotitle Left reverse noenhanced spacing 1.1
headline = ""; subline = ""
set style fill solid 1.0 border linecolor rgb "#303030"
set boxwidth 0.8
