# style.gp - what all figures share. `figure` and `provenance` are set before; data is in figure.".csv".
# Colours: Okabe and Ito, told apart by colour-blind readers; dashes and points differ too, for print in grey.
set encoding utf8
set datafile separator comma
set datafile missing ''
set datafile columnheaders
formats = "png svg"

# A format begins as the first did: what the last panel of the one before was called is forgotten.
page(format, w, h) = "unset title; unset xlabel; unset ylabel; ".(format eq "png" ? \
    sprintf("set terminal pngcairo size %d,%d font 'DejaVu Sans,%d' linewidth 2 enhanced; set output figure.'.png'", 2*w, 2*h, 19) : \
    sprintf("set terminal svg size %d,%d font 'DejaVu Sans,%d' linewidth 1.2 enhanced; set output figure.'.svg'", w, h, 13))

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
footer = sprintf("set label 99 \"%s\" at screen 0.99,0.012 right noenhanced font ',%%s' textcolor rgb '%s'", provenance, grey)
# The figure's own title and the line below it, at the height y of the page.
title_at(format, y) = sprintf("set label 97 headline at screen 0.5,%f center noenhanced font ',%d'; ". \
    "set label 98 subline at screen 0.5,%f center noenhanced textcolor rgb '%s'", y, format eq "png" ? 23 : 16, y - 0.032, grey)
small(format) = format eq "png" ? ",15" : ",10"
foot(format) = sprintf(footer, format eq "png" ? "11" : "8")

