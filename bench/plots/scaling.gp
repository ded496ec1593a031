# How the filter's time grows, as onmesh_bench_tables --csv has it.
# Arguments: the CSV file, the folder of the pictures.

data = ARG1
panel_of = "panel"
series_of = "series"
series = "'OpenCV 2D' direct nodes auto"
x_of = "x"
y_of = "seconds"
title = "Compute time of the bilateral filter"
y_label = "seconds"
lowest = 1e-4

plot_of = "texels"
x_label = "texels per side"
x_base = 2
x_format = "%g"
picture = ARG2 . "/scaling-texels.svg"
load "panels.gp"

plot_of = "sigma"
x_label = "sigma in texels"
x_base = 2
x_format = "%g"
picture = ARG2 . "/scaling-sigma.svg"
load "panels.gp"

plot_of = "threads"
x_label = "threads"
x_base = 2
x_format = "%g"
picture = ARG2 . "/scaling-threads.svg"
load "panels.gp"

plot_of = "mesh_size"
x_label = "faces"
x_base = 10
x_format = "%.0s%c"
picture = ARG2 . "/scaling-mesh_size.svg"
load "panels.gp"
