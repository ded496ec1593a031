// What the codes of an image mean as light.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "onmesh/image/image.h"

namespace onmesh {

/// The transfer function of an image's codes: to amounts of light, and back. Only these can be
/// averaged; primaries do not matter for that. Channels are converted one by one, unless an
/// OpenColorIO configuration says otherwise.
class ColourSpace {
 public:
  virtual ~ColourSpace() = default;

  /// From codes to linear light, in place.
  /// \param values `channels` values for each of `texels` texels
  virtual void to_linear(float* values, std::size_t texels, int channels) const = 0;
  /// The inverse. Codes of integer files are not rounded.
  virtual void from_linear(float* values, std::size_t texels, int channels) const = 0;

  /// Whether each channel is converted by itself: then codes of few levels can have a table.
  virtual bool is_per_channel() const { return true; }

  /// The matrix from the space's primaries to those of Rec. 709, 3 x 3 row by row; null if they are
  /// these, or not known. Means need none; how colours look does.
  virtual const float* to_rec709() const { return nullptr; }

  /// As find_colour_space() knows it.
  const std::string& name() const { return name_; }

 protected:
  /// \param name for people
  explicit ColourSpace(std::string name) : name_(std::move(name)) {}

 private:
  std::string name_;
};

/// The colour space of a name, in any case of letters: "sRGB" (IEC 61966-2-1), "Rec709" (ITU-R
/// BT.709), "GammaX" for a power of X, such as "Gamma2.2", "ACEScg" for linear light of AP1
/// primaries (Academy S-2014-004). If $OCIO names a configuration, its colour spaces and roles come
/// first. \return null for "linear", "raw" and "data", whose codes are averaged as they are \throw
/// InputError if it is unknown
std::shared_ptr<const ColourSpace> find_colour_space(std::string_view name);

/// Some channels in one space, the next in another, and so on: what maps have that are filtered
/// together.
/// \param parts how many channels each has; null = codes are light
/// \return null if all are
std::shared_ptr<const ColourSpace> join_colour_spaces(
    std::vector<std::pair<int, std::shared_ptr<const ColourSpace>>> parts);

/// Where a choice of colour space came from.
struct ColourSpaceChoice {
  std::shared_ptr<const ColourSpace> space;  ///< null: codes are averaged as they are
  std::string name;                          ///< "sRGB", "linear", "raw", "data", ...
  std::string reason;                        ///< for people
  bool has_no_alpha = false;  ///< said to be numbers: a fourth channel is one like the others
};

/// What was said about an image's colour space.
struct ColourSpaceRequest {
  /// What a texture is for, as far as it was said.
  enum class Role {
    unknown,       ///< nothing was said
    colour,        ///< amounts of light, in whatever space
    data,          ///< numbers
    normal_gl,     ///< numbers: normals in tangent space, green upwards
    normal_dx,     ///< the same with green downwards
    object_normal  ///< numbers: normals in the object's space
  };
  Role role = Role::unknown;    ///< of the texture
  std::string name;             ///< --colorspace; empty = nothing
  bool slot_is_data = false;    ///< a glTF slot that holds numbers
  bool slot_is_colour = false;  ///< a glTF slot that holds colours, which are sRGB
};

/// The colour space of an image: by the role; else the name given; else the glTF slot; else one or
/// two channels are data; else the file's tag, and the primaries that an EXR names; else integers
/// are sRGB and floats linear. The role `colour` leaves out what says data. \throw InputError as
/// find_colour_space()
ColourSpaceChoice choose_colour_space(const Image& image, const ColourSpaceRequest& request);

/// How many levels above 0 the codes of the image's file have: 255 or 65535; 0 = other than that.
int levels_of(const Image& image);

/// Whether the file holds colours that are multiplied with alpha: EXR, and TIFF that says so.
bool is_premultiplied(const Image& image);

}  // namespace onmesh
