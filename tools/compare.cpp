// onmesh compare: how two textures differ, and how visible their seams are.
#include <iomanip>
#include <iostream>
#include <nlohmann/json.hpp>

#include "command.h"
#include "inputs.h"
#include "onmesh/base/text.h"
#include "onmesh/image/image_io.h"
#include "onmesh/measure/image_difference.h"
#include "onmesh/measure/seam_error.h"
#include "texture_choice.h"

namespace onmesh::tools {
namespace {

Command make_command() {
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
  add("seams", flag(), "insist on the seam errors: an error without --mesh");
  add("json", flag(), "the result as JSON on stdout");
  command.positional.add("a", 1).add("b", 1);
  return command;
}

Image read_other(const std::string& path, const std::string& first, const Image& like) {
  Image image = read_image(path);
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

nlohmann::json to_json(const SeamError& s) {
  return {{"edges", s.edges}, {"length", s.length}, {"rms", s.rms}, {"max", s.max}};
}

void row(const char* name, const std::string& value) {
  std::cout << std::left << std::setw(14) << name << value << '\n';
}

}  // namespace

int run_compare(const std::vector<std::string>& arguments) {
  const Command command = make_command();
  po::variables_map values;
  if (!parse(command, arguments, values)) return 0;
  const std::string path_a = argument_of(command, values, "a");
  const std::string path_b = argument_of(command, values, "b");
  std::optional<double> least;
  if (has(values, "fail")) least = number_of(values, "fail", -1000, 1000);
  for (const std::string name : {"wrap", "seams", "material"}) {
    const bool given =
        name == "seams" ? flag_of(values, name) : has(values, name) && !values[name].defaulted();
    if (given && !has(values, "mesh")) throw UsageError("--" + name + " needs --mesh");
  }
  const Wrap wrap = wrap_of(values);

  const Image a = read_image(path_a);
  const Image b = read_other(path_b, path_a, a);
  check_interrupted();
  ImageDifference result;
  std::optional<SeamError> seams_a, seams_b;
  if (has(values, "mesh")) {
    const InputMesh input = read_input_mesh(text_of(values, "mesh"));
    warn(input.warnings);
    check_interrupted();
    const std::vector<bool> faces =
        faces_wearing(input.cleaned, path_a, path_b, optional_text(values, "material"));
    naming(input.path, [&] {
      const TexelMap map = make_texel_map(input.cleaned, a.width, a.height, {wrap, faces});
      if (map.claims.empty())
        throw InputError("no texel is covered, so there is nothing to compare");
      result = difference(a, b, &map);
      check_interrupted();
      seams_a = seam_error(input.cleaned, map, a);
      seams_b = seam_error(input.cleaned, map, b);
    });
  } else {
    result = naming(path_b, [&] { return difference(a, b); });
  }
  check_interrupted();

  const Index column = result.worst_texel % Index(a.width);
  const Index line = result.worst_texel / Index(a.width);
  const bool passed = !least || result.psnr >= *least;
  if (flag_of(values, "json")) {
    nlohmann::json json = new_report("compare");
    json["a"] = path_a;
    json["b"] = path_b;
    json["mesh"] = has(values, "mesh") ? nlohmann::json(text_of(values, "mesh")) : nlohmann::json();
    json["width"] = a.width;
    json["height"] = a.height;
    json["channels"] = a.channels;
    json["texels"] = result.texels;
    json["equal"] = result.max == 0;
    json["psnr"] = result.psnr;
    json["rms"] = result.rms;
    json["max"] = result.max;
    json["worst_texel"] = {column, line};
    json["seams_a"] = seams_a ? to_json(*seams_a) : nlohmann::json();
    json["seams_b"] = seams_b ? to_json(*seams_b) : nlohmann::json();
    json["fail"] = least ? nlohmann::json(*least) : nlohmann::json();
    json["passed"] = passed;
    print_report(std::move(json));
  } else {
    row("texels", format_count(result.texels));
    row("PSNR", result.max == 0 ? "infinite, all are equal" : format_number(result.psnr) + " dB");
    row("rms error", format_number(result.rms));
    std::string worst = format_number(result.max);
    if (result.max > 0)
      worst += " at column " + std::to_string(column) + ", row " + std::to_string(line);
    row("max error", worst);
    const auto seam_row = [](const char* name, const SeamError& s) {
      row(name, "rms " + format_number(s.rms) + ", max " + format_number(s.max) + " over " +
                    format_count(s.edges) + " edges");
    };
    if (seams_a) seam_row("seams of A", *seams_a);
    if (seams_b) seam_row("seams of B", *seams_b);
  }
  if (passed) return 0;
  std::cout.flush();
  std::cerr << "onmesh compare: " << path_b << " differs from " << path_a << ": PSNR "
            << format_number(result.psnr) << " dB is below --fail " << text_of(values, "fail")
            << '\n';
  return 1;
}

}  // namespace onmesh::tools
