# The second part of panels.gp: draws the panels with what it found.

# Grey text and no background: readable on white and on black pages.
grey = "#6e7781"
array colour[5] = ["#848d97", "#2f81f7", "#d4721a", "#2da44e", "#a371f7"]
array marker[5] = [7, 5, 9, 12, 6]
array marker_size[5] = [0.5, 0.5, 0.65, 0.9, 0.6]

# ---- Ranges of the axes

if (lowest > 0) {
  step = 10
  y_low = 10.0 ** floor(log10(Y_min) + 1e-9)
  y_high = 10.0 ** ceil(log10(Y_max) - 1e-9)
  y_high = y_high > y_low ? y_high : 10 * y_low
} else {
  extent = Y_max > Y_min ? Y_max - Y_min : 1.0
  step = 10.0 ** floor(log10(extent))
  while (extent / step < 3) { step = step / 2 }
  y_low = step * floor(Y_min / step + 1e-9)
  y_high = step * ceil(Y_max / step - 1e-9)
  y_high = y_high > y_low ? y_high : y_low + extent
}
x_room = X_max > X_min ? (X_max / X_min) ** 0.12 : 2.0

# ---- Measures, in pixels

columns = words(panels) < 4 ? words(panels) : 4
rows = (words(panels) + columns - 1) / columns
panel_width = columns < 3 ? 330 : 190
panel_height = columns < 3 ? 200 : 130
gap_x = 22; gap_y = 46; left = 84; right = 12; top = 84; bottom = 48
panels_end = left + columns * (panel_width + gap_x) - gap_x
least_width = left + 7.6 * strlen(title) + right
width = panels_end + right < least_width ? least_width : panels_end + right
height = top + rows * (panel_height + gap_y) - gap_y + bottom
across(x) = x / real(width)
down(y) = 1 - y / real(height)

# ---- What all panels share

set terminal svg size width,height fixed font "sans-serif,12" noenhanced butt
set output picture
set multiplot
set label 1 title at screen across(left), screen down(18) font "sans-serif,15" textcolor rgb grey
set label 2 x_label at screen across((left + panels_end) / 2), screen down(height - 10) center \
  textcolor rgb grey
set label 3 y_label at screen across(14), screen down((top + height - bottom) / 2) center \
  rotate by 90 textcolor rgb grey
set border 1 linecolor rgb grey
set grid ytics linetype 1 linewidth 0.4 linecolor rgb grey
set tics nomirror scale 0 textcolor rgb grey font ",11"
set logscale x x_base
set xtics x_base ** floor(log(X_min) / log(x_base) + 1e-9), x_base
set xrange [X_min / x_room : X_max * x_room]
set format x x_format
set yrange [y_low : y_high]
if (lowest > 0) { set logscale y 10 }
set xtics offset 0,0.3
unset key

# The legend: one label with the series' marker per name.
rank(name) = (sum [i = 1:words(series)] (word(series, i) eq name ? i : 0))
x = left + 6
do for [name in measured] {
  s = rank(name)
  set label name at screen across(x), screen down(44) left offset 1.2,-0.25 textcolor rgb grey \
    point linecolor rgb colour[s] pointtype marker[s] pointsize marker_size[s]
  x = x + 36 + 7.5 * strlen(name)
}

# ---- The panels

do for [p = 1:words(panels)] {
  panel = word(panels, p)
  x0 = left + (p - 1) % columns * (panel_width + gap_x)
  y0 = top + (p - 1) / columns * (panel_height + gap_y)
  set lmargin at screen across(x0)
  set rmargin at screen across(x0 + panel_width)
  set tmargin at screen down(y0)
  set bmargin at screen down(y0 + panel_height)
  set title panel offset 0,-0.6 textcolor rgb grey
  set ytics step
  set format y (x0 == left ? "%g" : "")
  if (x0 == left && lowest > 0 && Y_min <= lowest) {
    set ytics add (sprintf("≤ %g", lowest) lowest)
  }
  plot for [name in measured] data \
    using (strcol(panel_of) eq panel && strcol(series_of) eq name ? x_value(0) : NaN):(y_value(0)) \
    with linespoints linewidth 1.5 linecolor rgb colour[rank(name)] \
    pointtype marker[rank(name)] pointsize marker_size[rank(name)] title name
  unset label
}
unset multiplot
