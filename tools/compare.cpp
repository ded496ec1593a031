// onmesh compare: how two textures differ, and how visible their seams are.
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "format.h"
#include "interruption.h"
#include "messages.h"
#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"
#include "onmesh/measure/image_difference.h"
#include "onmesh/measure/seam_error.h"
#include "report.h"
#include "shared_options.h"
#include "subcommands.h"
#include "texture_choice.h"

namespace onmesh::tools {

Command compare_command() {
  Command command;
  command.name = "compare";
  command.synopsis = "A B [--mesh MESH] [--fail DB] [options]";
  command.summary =
      "Measures how two textures of one size differ. With their mesh only the texels that its\n"
      "charts cover count, and the seam error of both is measured: the difference of bilinear\n"
      "look-ups on both sides of every seam edge.";
  command.examples =
      "  onmesh compare cube.png filtered.png\n"
      "  onmesh compare cube.png filtered.png --mesh cube.obj --json\n"
      "  onmesh compare expected.exr filtered.exr --fail 60\n";
  auto add = command.options.add_options();
  add("a", text());
  add("b", text());
  add("mesh", text(), "the mesh that wears the textures");
  add("material", text(), "only the faces of this material; all = every face with UVs");
  add("wrap", text("repeat"), "what UVs outside [0,1] mean: repeat or clamp");
  add("fail", text(), "exit with 1 if the PSNR is below this many dB");
  add_weld_option(command.options);
  add("seams", flag(), "insist on the seam errors: an error without --mesh");
  add("json", flag(), "the result as JSON on stdout");
  command.positional.add("a", 1).add("b", 1);
  return command;
}

namespace {

Image read_other(const std::string& path, const std::string& first, const Image& like) {
  Image image = read_texture(path);
  const auto size = [](const Image& i) {
    return std::to_string(i.width) + " x " + std::to_string(i.height) + " with " +
           count_text(std::uint64_t(i.channels), "channel", "channels");
  };
  if (size(image) != size(like))
    throw InputError(path + ": " + size(image) + " cannot be compared with " + first + ": " +
                     size(like));
  return image;
}

// The faces that filter would have chosen for one of the textures: the other is its result.
std::vector<bool> faces_wearing(const TriangleMesh& mesh, const std::string& a,
                                const std::string& b, const std::optional<std::string>& material) {
  try {
    return choose_texture(mesh, a, material).faces;
  } catch (const UsageError&) {
    if (material) throw;
  }
  try {
    return choose_texture(mesh, b, material).faces;
  } catch (const UsageError&) {
    throw UsageError("--mesh: none of its materials names " + a + " or " + b +
                     "; choose the faces with --material NAME or --material all");
  }
}

struct Comparison {
  ImageDifference difference;
  std::optional<SeamError> seams_a, seams_b;  ///< with a mesh
};

/// On the texels that the mesh's charts cover, and at its seams.
Comparison compare_on_mesh(const Arguments& arguments, const Image& a, const Image& b) {
  const InputMesh input = read_input_mesh(arguments.text("mesh"), weld_of(arguments));
  warn(input.warnings);
  check_interrupted();
  const std::vector<bool> faces =
      faces_wearing(input.cleaned, arguments.argument("a"), arguments.argument("b"),
                    arguments.optional_text("material"));
  return naming(input, [&] {
    const TexelMap map =
        make_texel_map(input.cleaned, a.width, a.height, {wrap_of(arguments), faces});
    if (map.claims.empty()) throw InputError("no texel is covered, so there is nothing to compare");
    Comparison result;
    result.difference = difference(a, b, &map);
    check_interrupted();
    result.seams_a = seam_error(input.cleaned, map, a);
    result.seams_b = seam_error(input.cleaned, map, b);
    return result;
  });
}

nlohmann::json comparison_json(const Comparison& result, int width) {
  const ImageDifference& d = result.difference;
  return {{"texels", d.texels},
          {"equal", d.max == 0},
          {"psnr", d.psnr},
          {"rms", d.rms},
          {"max", d.max},
          {"worst_texel", {d.worst_texel % Index(width), d.worst_texel / Index(width)}},
          {"seams_a", result.seams_a ? to_json(*result.seams_a) : nlohmann::json()},
          {"seams_b", result.seams_b ? to_json(*result.seams_b) : nlohmann::json()}};
}

void print_json(const Arguments& arguments, const Image& a, const Comparison& result,
                std::optional<double> least, bool passed) {
  nlohmann::json json = new_report("compare");
  json["a"] = arguments.argument("a");
  json["b"] = arguments.argument("b");
  json["mesh"] = text_or_null(arguments.optional_text("mesh").value_or(""));
  json["width"] = a.width;
  json["height"] = a.height;
  json["channels"] = a.channels;
  json.update(comparison_json(result, a.width));
  json["fail"] = least ? nlohmann::json(*least) : nlohmann::json();
  json["passed"] = passed;
  print_report(std::move(json));
}

void row(const char* name, const std::string& value) {
  std::cout << std::left << std::setw(14) << name << value << '\n';
}

void seam_row(const char* name, const std::optional<SeamError>& s) {
  if (!s) return;
  row(name, "rms " + format_number(s->rms) + ", max " + format_number(s->max) + " over " +
                format_count(s->edges) + " edges");
}

void print_text(const Comparison& result, int width) {
  const ImageDifference& d = result.difference;
  row("texels", format_count(d.texels));
  row("PSNR", d.max == 0 ? "infinite, all are equal" : format_number(d.psnr) + " dB");
  row("rms error", format_number(d.rms));
  std::string worst = format_number(d.max);
  if (d.max > 0) {
    worst += " at column " + std::to_string(d.worst_texel % Index(width)) + ", row " +
             std::to_string(d.worst_texel / Index(width));
  }
  row("max error", worst);
  seam_row("seams of A", result.seams_a);
  seam_row("seams of B", result.seams_b);
}

}  // namespace

int run_compare(const Arguments& arguments) {
  const std::string path_a = arguments.argument("a"), path_b = arguments.argument("b");
  std::optional<double> least;
  if (arguments.has("fail")) least = arguments.number("fail", -1000, 1000);
  arguments.require_with({"wrap", "seams", "material", "weld"}, "mesh");
  wrap_of(arguments);

  const Image a = read_texture(path_a);
  const Image b = read_other(path_b, path_a, a);
  check_interrupted();
  Comparison result;
  if (arguments.has("mesh")) {
    result = compare_on_mesh(arguments, a, b);
  } else {
    result.difference = naming(path_b, [&] { return difference(a, b); });
  }
  check_interrupted();

  const bool passed = !least || result.difference.psnr >= *least;
  if (arguments.flag("json")) {
    print_json(arguments, a, result, least, passed);
  } else {
    print_text(result, a.width);
  }
  if (passed) return 0;
  std::cout.flush();
  std::cerr << "onmesh compare: " << path_b << " differs from " << path_a << ": PSNR "
            << format_number(result.difference.psnr) << " dB is below --fail "
            << arguments.text("fail") << '\n';
  return 1;
}

}  // namespace onmesh::tools
