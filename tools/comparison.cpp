#include <cmath>
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "comparison.h"
#include "format.h"
#include "report.h"

namespace onmesh::tools {
namespace {

nlohmann::json difference_json(const ImageDifference& d, int width) {
  return {{"texels", d.texels},
          {"equal", d.max == 0},
          {"psnr", d.psnr},
          {"rms", d.rms},
          {"max", d.max},
          {"worst_texel", {d.worst_texel % Index(width), d.worst_texel / Index(width)}}};
}

nlohmann::json light_json(const LightDifference& light) {
  const auto error = [](const LightError& e) {
    return nlohmann::json{{"rel_mse", e.rel_mse}, {"log_psnr", e.log_psnr}};
  };
  nlohmann::json json = error(light.colour);
  json["alpha"] = light.alpha ? error(*light.alpha) : nlohmann::json();
  return json;
}

nlohmann::json residual_json(const std::optional<SeamResidual>& residual) {
  if (!residual) return nullptr;
  return {{"rms_at_seams", residual->seams},       {"rms_at_folds", residual->folds},
          {"rms_inside", residual->inside},        {"values_at_seams", residual->at_seams},
          {"values_at_folds", residual->at_folds}, {"values_inside", residual->within}};
}

void row(const std::string& name, const std::string& value) {
  std::cout << std::left << std::setw(14) << name << value << '\n';
}

void seam_row(const char* name, const std::optional<SeamError>& s) {
  if (!s) return;
  row(name, "rms " + format_number(s->rms) + ", max " + format_number(s->max) + " over " +
                format_count(s->edges) + " edges");
}

std::string decibels_text(double psnr) {
  return std::isfinite(psnr) ? format_number(psnr) + " dB" : "infinite, all are equal";
}

std::string psnr_text(const ImageDifference& d) { return decibels_text(d.psnr); }

void light_rows(const std::string& of, const LightError& error) {
  row(of + "relMSE", format_number(error.rel_mse));
  row(of + "logPSNR", decibels_text(error.log_psnr));
}

}  // namespace

void print_json(const Arguments& arguments, const Comparison& result, std::optional<double> least,
                bool passed) {
  const auto seams = [](const std::optional<SeamError>& s) {
    return s ? to_json(*s) : nlohmann::json();
  };
  nlohmann::json json = new_report("compare");
  json["a"] = arguments.argument("a");
  json["b"] = arguments.argument("b");
  json["mesh"] = text_or_null(result.mesh);
  json["width"] = result.a[0].width;
  json["height"] = result.a[0].height;
  json["channels"] = result.a[0].channels;
  json.update(difference_json(result.all, result.width()));
  json["light"] = light_json(result.all_light);
  json["files"] = nlohmann::json::array();
  for (std::size_t i = 0; i < result.pairs.size(); ++i) {
    nlohmann::json file = difference_json(result.parts[i], result.a[i].width);
    file["light"] = light_json(result.light[i]);
    file["a"] = result.pairs[i].a.string();
    file["b"] = result.pairs[i].b.string();
    json["files"].push_back(std::move(file));
  }
  json["seams_a"] = seams(result.seams_a);
  json["seams_b"] = seams(result.seams_b);
  json["seam_residual"] = residual_json(result.residual);
  json["fail"] = least ? nlohmann::json(*least) : nlohmann::json();
  json["passed"] = passed;
  print_report(std::move(json));
}

void print_text(const Comparison& result) {
  const ImageDifference& d = result.all;
  for (std::size_t i = 0; result.pairs.size() > 1 && i < result.pairs.size(); ++i)
    row(result.pairs[i].b.filename().string() + "  ", psnr_text(result.parts[i]));
  row("texels", format_count(d.texels));
  row("PSNR", psnr_text(d));
  row("rms error", format_number(d.rms));
  std::string worst = format_number(d.max);
  if (d.max > 0) {
    worst += " at column " + std::to_string(d.worst_texel % Index(result.width())) + ", row " +
             std::to_string(d.worst_texel / Index(result.width())) + result.worst_file();
  }
  row("max error", worst);
  light_rows("", result.all_light.colour);
  if (result.all_light.alpha) light_rows("alpha ", *result.all_light.alpha);
  seam_row("seams of A", result.seams_a);
  seam_row("seams of B", result.seams_b);
  if (!result.residual || !(result.residual->inside > 0)) return;
  const auto residual_row = [&](const char* name, double rms, std::size_t count) {
    if (count == 0) return;
    row(name, "rms " + format_number(rms) + " from side to side, " +
                  format_number(rms / result.residual->inside) + " times that at other edges");
  };
  residual_row("A - B at seams ", result.residual->seams, result.residual->at_seams);
  residual_row("A - B at folds ", result.residual->folds, result.residual->at_folds);
}

}  // namespace onmesh::tools
