# Draws one picture of small panels with the same axes from a CSV file that has one measurement per
# line. Loaded by the scripts of this folder, which set:
#
#   data, picture       the CSV file and the SVG file
#   title, x_label, y_label
#   panel_of, series_of, x_of, y_of    names of columns
#   plot_of             lines that have this in their column "plot"; "" = all lines
#   series              names of series, in the order of their colours
#   x_base, x_format    the x axis is logarithmic to this base; how its numbers are written
#   lowest              where the y axis ends at the latest, smaller values are drawn there; then it is
#                       logarithmic, with 0 linear

reset
set encoding utf8

# What there is: panels and series that have numbers, and the ranges of these.

set datafile separator comma
set datafile columnheaders
set datafile missing NaN
in_plot(n) = plot_of eq "" || strcol("plot") eq plot_of
y_value(n) = !in_plot(0) ? NaN : column(y_of) < lowest ? lowest : column(y_of)
x_value(n) = in_plot(0) ? column(x_of) : NaN
added(names, name) = strstrt(names, "'" . name . "'") ? names : names . " '" . name . "'"
noted(y) = y != y ? y : (panels = added(panels, strcol(panel_of)), \
                         measured = added(measured, strcol(series_of)), y)
panels = ""
measured = ""
stats data using (noted(y_value(0))) name "Y" nooutput
stats data using (x_value(0)) name "X" nooutput
if (words(panels) > 0) {
  load "draw_panels.gp"
} else {
  print "no numbers for ", picture
}
