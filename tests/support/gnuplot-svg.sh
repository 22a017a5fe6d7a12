#!/bin/sh
# gnuplot-svg.sh - in gnuplot's place under sanitizers, which see nothing of gnuplot, and where many figures are drawn: the
# SVG of a figure, which the program reads again, is gnuplot's; the PNG, half of the time for no eye, is one pixel.
# Called as the program calls gnuplot: -d SCRIPT.
[ "$1" = -d ] || exit 64
sed 's/^formats = "png svg"$/formats = "svg"/' "$2" >"$2.svg-only"
gnuplot -d "$2.svg-only"
status=$?
rm -f "$2.svg-only"
name=${2%.gp}
[ ! -s "$name.svg" ] ||
    printf '\211PNG\r\n\032\n\0\0\0\rIHDR\0\0\0\001\0\0\0\001\b\0\0\0\0\072\176\233\125\0\0\0\nIDATx\234c`\0\0\0\002\0\001\110\257\244\161\0\0\0\0IEND\256B`\202' \
        >"$name.png"
exit $status
