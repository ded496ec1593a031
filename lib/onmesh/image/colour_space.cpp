#include "onmesh/image/colour_space.h"

#include <OpenImageIO/color.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <utility>
#include <vector>

#include "onmesh/base/error.h"
#include "onmesh/base/text.h"
#include "onmesh/base/text_scan.h"
#include "onmesh/image/native_pixels.h"

namespace onmesh {
namespace {

/// A function of one channel, applied to each.
template <class Curve>
class CurveSpace final : public ColourSpace {
 public:
  CurveSpace(std::string name, Curve curve) : ColourSpace(std::move(name)), curve_(curve) {}

  void to_linear(float* values, std::size_t texels, int channels) const override {
    for (float* v = values; v != values + texels * std::size_t(channels); ++v)
      *v = curve_.to_linear(*v);
  }
  void from_linear(float* values, std::size_t texels, int channels) const override {
    for (float* v = values; v != values + texels * std::size_t(channels); ++v)
      *v = curve_.from_linear(*v);
  }

 private:
  Curve curve_;
};

/// A straight part and a power, odd around 0: codes may be negative.
struct Power {
  // exponent > 0, slope > 0
  float exponent, offset, slope, knee;  ///< light = ((code + offset) / (1 + offset)) ^ exponent

  float to_linear(float code) const {
    const float c = std::abs(code);
    if (c <= knee) return code / slope;
    return std::copysign(std::pow((c + offset) / (1 + offset), exponent), code);
  }
  float from_linear(float light) const {
    const float l = std::abs(light);
    if (l * slope <= knee) return light * slope;
    return std::copysign((1 + offset) * std::pow(l, 1 / exponent) - offset, light);
  }
};

/// See join_colour_spaces().
class JoinedSpaces final : public ColourSpace {
 public:
  using Parts = std::vector<std::pair<int, std::shared_ptr<const ColourSpace>>>;
  explicit JoinedSpaces(Parts parts) : ColourSpace("several"), parts_(std::move(parts)) {}

  void to_linear(float* values, std::size_t texels, int channels) const override {
    convert(values, texels, channels, &ColourSpace::to_linear);
  }
  void from_linear(float* values, std::size_t texels, int channels) const override {
    convert(values, texels, channels, &ColourSpace::from_linear);
  }
  bool is_per_channel() const override {
    return std::all_of(parts_.begin(), parts_.end(), [](const auto& part) {
      return !part.second || part.second->is_per_channel();
    });
  }
  /// Of the first that has one.
  const float* to_rec709() const override {
    for (const auto& [count, space] : parts_)
      if (space && space->to_rec709() != nullptr) return space->to_rec709();
    return nullptr;
  }

 private:
  using Conversion = void (ColourSpace::*)(float*, std::size_t, int) const;

  void convert(float* values, std::size_t texels, int channels, Conversion conversion) const {
    std::vector<float> own;
    int first = 0;
    for (const auto& [count, space] : parts_) {
      if (space) {
        const auto size = std::size_t(count);
        own.resize(texels * size);
        float* at = values + first;
        for (std::size_t t = 0; t < texels; ++t, at += channels)
          std::copy_n(at, size, &own[t * size]);
        (space.get()->*conversion)(own.data(), texels, count);
        at = values + first;
        for (std::size_t t = 0; t < texels; ++t, at += channels)
          std::copy_n(&own[t * size], size, at);
      }
      first += count;
    }
  }

  const Parts parts_;
};

constexpr Power kSrgb{2.4F, 0.055F, 12.92F, 0.04045F};
// With so many digits both parts meet (ITU-R BT.2020, which has the same curve).
constexpr Power kRec709{1 / 0.45F, 0.099296827F, 4.5F, 0.081242858F};

/// Linear light of AP1 primaries.
class AcesCg final : public ColourSpace {
 public:
  AcesCg() : ColourSpace("ACEScg") {}
  void to_linear(float*, std::size_t, int) const override {}
  void from_linear(float*, std::size_t, int) const override {}
  const float* to_rec709() const override {
    // Its white is D60, adapted to D65 (Bradford).
    static constexpr float kMatrix[] = {1.70505F,  -0.62179F, -0.08326F, -0.13026F, 1.14080F,
                                        -0.01055F, -0.02400F, -0.12897F, 1.15297F};
    return kMatrix;
  }
};

/// A colour space of an OpenColorIO configuration.
class ConfiguredSpace final : public ColourSpace {
 public:
  ConfiguredSpace(const std::string& name, OIIO::ColorProcessorHandle to,
                  OIIO::ColorProcessorHandle from)
      : ColourSpace(name), to_(std::move(to)), from_(std::move(from)) {}

  void to_linear(float* values, std::size_t texels, int channels) const override {
    apply(*to_, values, texels, channels);
  }
  void from_linear(float* values, std::size_t texels, int channels) const override {
    apply(*from_, values, texels, channels);
  }
  bool is_per_channel() const override { return !to_->hasChannelCrosstalk(); }

 private:
  /// Processors want three channels; a single one is grey.
  static void apply(const OIIO::ColorProcessor& processor, float* values, std::size_t texels,
                    int channels) {
    constexpr OIIO::stride_t kFloat = sizeof(float);
    if (channels == 3) {
      processor.apply(values, int(texels), 1, 3, kFloat, 3 * kFloat,
                      OIIO::stride_t(texels) * 3 * kFloat);
      return;
    }
    for (std::size_t v = 0; v < texels * std::size_t(channels); ++v) {
      float grey[3] = {values[v], values[v], values[v]};
      processor.apply(grey, 1, 1, 3, kFloat, 3 * kFloat, 3 * kFloat);
      values[v] = grey[1];
    }
  }

  OIIO::ColorProcessorHandle to_, from_;
};

bool has_configuration() {
  const char* const path = std::getenv("OCIO");
  return path != nullptr && *path != '\0';
}

std::shared_ptr<const ColourSpace> find_configured(const std::string& name) {
  OIIO::ColorConfig config;
  if (config.error()) throw InputError("$OCIO: " + config.geterror());
  std::string known;
  const std::string wanted = lower_case(name);
  for (const std::string& space : config.getColorSpaceNames())
    if (lower_case(space) == wanted) known = space;
  if (known.empty()) {
    const char* const by_role = config.getColorSpaceNameByRole(name);
    if (by_role != nullptr) known = by_role;
  }
  const char* const linear = config.getColorSpaceNameByRole("scene_linear");
  if (known.empty() || linear == nullptr) return nullptr;
  OIIO::ColorProcessorHandle to = config.createColorProcessor(OIIO::string_view(known), linear);
  OIIO::ColorProcessorHandle from =
      config.createColorProcessor(OIIO::string_view(linear), OIIO::string_view(known));
  if (!to || !from) {
    throw InputError("colour space '" + name +
                     "' of $OCIO cannot be converted both ways: " + config.geterror());
  }
  return std::make_shared<ConfiguredSpace>(known, std::move(to), std::move(from));
}

bool is_one_of(const std::string& word, std::initializer_list<const char*> list) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

std::string tag_of(const Image& image) {
  if (!image.source) return {};
  return std::string(image.source->spec.get_string_attribute("oiio:ColorSpace"));
}

/// Whether the file names the primaries of ACEScg: its name does not survive an EXR.
bool has_ap1_primaries(const Image& image) {
  if (!image.source) return false;
  constexpr float kAp1[] = {0.713F, 0.293F, 0.165F, 0.830F, 0.128F, 0.044F, 0.32168F, 0.33767F};
  const auto* const found =
      image.source->spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  if (found == nullptr) return false;
  const auto* const values = static_cast<const float*>(found->data());
  return std::equal(std::begin(kAp1), std::end(kAp1), values,
                    [](float a, float b) { return std::abs(a - b) < 1e-3F; });
}

bool is_integer(const Image& image) {
  if (!image.source) return false;
  const std::vector<SampleType>& types = image.source->types;
  return std::any_of(types.begin(), types.end(), [](SampleType type) {
    return type != OIIO::TypeDesc::FLOAT && type != OIIO::TypeDesc::HALF &&
           type != OIIO::TypeDesc::DOUBLE;
  });
}

ColourSpaceChoice named(const std::string& name, std::string reason) {
  ColourSpaceChoice choice;
  choice.space = find_colour_space(name);
  choice.name = choice.space ? choice.space->name() : lower_case(name);
  choice.reason = std::move(reason);
  choice.has_no_alpha = choice.name == "data";
  return choice;
}

}  // namespace

std::shared_ptr<const ColourSpace> find_colour_space(std::string_view name) {
  const std::string word = lower_case(std::string(name));
  if (is_one_of(word, {"raw", "data"})) return nullptr;
  if (has_configuration()) {
    if (std::shared_ptr<const ColourSpace> space = find_configured(std::string(name))) return space;
  }
  if (is_one_of(word, {"linear", "scene_linear", "lin_srgb", "lin_rec709"})) return nullptr;
  if (is_one_of(word, {"srgb", "srgb_texture", "srgb texture"}))
    return std::make_shared<CurveSpace<Power>>("sRGB", kSrgb);
  if (is_one_of(word, {"rec709", "bt709"}))
    return std::make_shared<CurveSpace<Power>>("Rec709", kRec709);
  if (word == "acescg") return std::make_shared<AcesCg>();
  for (const std::string_view prefix : {"gammacorrected", "gamma"}) {
    if (word.rfind(prefix, 0) != 0) continue;
    char* end = nullptr;
    const std::string number = word.substr(prefix.size());
    const double gamma = std::strtod(number.c_str(), &end);
    if (end == number.c_str() || *end != '\0' || !(gamma >= 0.1 && gamma <= 10)) break;
    if (gamma == 1) return nullptr;
    return std::make_shared<CurveSpace<Power>>("Gamma" + number, Power{float(gamma), 0, 1, 0});
  }
  throw InputError("unknown colour space '" + std::string(name) + "': there are sRGB, Rec709, " +
                   "GammaX, ACEScg, linear and raw" +
                   (has_configuration() ? ", and those of $OCIO" : "; $OCIO may name more"));
}

std::shared_ptr<const ColourSpace> join_colour_spaces(
    std::vector<std::pair<int, std::shared_ptr<const ColourSpace>>> parts) {
  if (parts.size() == 1) return parts[0].second;
  if (std::all_of(parts.begin(), parts.end(), [](const auto& part) { return !part.second; }))
    return nullptr;
  return std::make_shared<JoinedSpaces>(std::move(parts));
}

ColourSpaceChoice choose_colour_space(const Image& image, const ColourSpaceRequest& request) {
  using Role = ColourSpaceRequest::Role;
  const bool is_colour = request.role == Role::colour;
  if (request.role != Role::unknown && !is_colour) return {nullptr, "data", "its role", true};
  if (!request.name.empty() && !(is_colour && lower_case(request.name) == "data"))
    return named(request.name, "asked for");
  if (request.slot_is_data && !is_colour) return {nullptr, "data", "the glTF slot", false};
  if (request.slot_is_colour) return named("sRGB", "the glTF slot");
  const int colours = image.channels - (image.alpha_channel >= 0 ? 1 : 0);
  if (image.channels <= 2 && !is_colour)
    return {nullptr, "data", count_text(std::uint64_t(image.channels), "channel", "channels"),
            false};
  if (has_ap1_primaries(image)) return named("ACEScg", "the file's chromaticities");
  const std::string tag = tag_of(image);
  if (!tag.empty() && colours > 0) {
    try {
      return named(tag, "the file's tag");
    } catch (const InputError&) {
      // A tag that nobody knows says nothing.
    }
  }
  return is_integer(image) ? named("sRGB", "integers") : named("linear", "floats");
}

int levels_of(const Image& image) {
  if (!image.source || image.source->types.empty()) return 0;
  const std::vector<SampleType>& types = image.source->types;
  const auto all = [&](SampleType type) {
    return std::all_of(types.begin(), types.end(), [&](SampleType t) { return t == type; });
  };
  if (all(OIIO::TypeDesc::UINT8)) return 255;
  return all(OIIO::TypeDesc::UINT16) ? 65535 : 0;
}

bool is_premultiplied(const Image& image) {
  if (image.alpha_channel < 0 || !image.source) return false;
  const Image::Source& source = *image.source;
  return (source.format == "openexr" || source.format == "tiff") &&
         source.spec.get_int_attribute("oiio:UnassociatedAlpha") == 0;
}

}  // namespace onmesh
