# style.gp - what all figures share. The variable figure, a file's name, is set before; data is in figure.".csv".
# Texts of a database are read as columns of data files and shown as strings that are not enhanced. None becomes a part of
# a command: nothing in this folder evaluates a text, expands a macro, starts a program or loads a file.
# Colours: Okabe and Ito, told apart by colour-blind readers; dashes and points differ too, for print in grey.
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

png_font = "DejaVu Sans,19"; svg_font = "DejaVu Sans,13"
large(format) = format eq "png" ? ",23" : ",16"
small(format) = format eq "png" ? ",15" : ",10"
least(format) = format eq "png" ? ",11" : ",8"

array colour[8] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000", "#8c6d1f"]
array point[8] = [7, 5, 9, 13, 11, 6, 4, 8]
array dash[8] = [1, 2, 4, 5, 3, 1, 2, 4]
# The fastest serial code is always one of the others: a wide pale band under that one's curve.
band = "#d0d0d0"
grey = "#767676"
pale = "#b8b8b8"

# One bar part of a stage: computing dark, waiting light, so that the order shows in grey too.
compute_colour = "#0072b2"
send_colour = "#e69f00"
recv_colour = "#f0e442"
wait_colour = "#f6f6f6"
contention_colour = "#d55e00"

set border 3 linewidth 0.8
set tics nomirror out scale 0.6
set grid linecolor rgb "#e4e4e4" linewidth 0.6 linetype 1
set key noautotitle Left reverse noenhanced
headline = ""; subline = ""
set style fill solid 1.0 border linecolor rgb "#303030"
set boxwidth 0.8
