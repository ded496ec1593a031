# What onmesh_compare_backends --csv measured, one panel per mesh.
# Arguments: the CSV file, the folder of the pictures.

data = ARG1
panel_of = "mesh"
series_of = "backend"
series = "exact unfold heat cloud Euclidean"
plot_of = ""
x_of = "sigma_texels"
x_label = "sigma in texels"
x_base = 2
x_format = "%g"

picture = ARG2 . "/backend-errors.svg"
title = "Mean error of distances within the kernel"
y_of = "error_mean_sigma"
y_label = "error / sigma"
lowest = 1e-5
load "panels.gp"

picture = ARG2 . "/backend-psnr.svg"
title = "Gaussian filter against its definition with exact distances"
y_of = "psnr_gaussian_db"
y_label = "PSNR / dB"
lowest = 0
load "panels.gp"

picture = ARG2 . "/backend-times.svg"
title = "Time for the distances from one node, precomputation included"
y_of = "us_per_source"
y_label = "microseconds"
lowest = 1e-3
load "panels.gp"
