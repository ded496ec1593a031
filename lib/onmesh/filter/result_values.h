// From the filter's results in linear light to the codes of its images.
#pragma once

#include <vector>

#include "onmesh/filter/working_values.h"

namespace onmesh {

/// Copies of the textures while results are written into them: first with working values in the
/// place of codes, in the end with codes again.
class ResultValues {
 public:
  /// Puts the working values of covered texels into the images.
  /// \param images copies of the textures
  /// \pre `working` and the images outlive this
  ResultValues(const WorkingValues& working, std::vector<Image>& images);

  /// Those of the images.
  const TexelValues& values() const { return values_; }

  /// Go only so far from the values as read to the results, and add detail, as
  /// FilterOptions::strength and detail_gain say. Texels that had no value keep the result.
  /// \param mask per texel, see chart_mask(); empty = 1 everywhere
  void blend(const FilterOptions& options, const std::vector<float>& mask) const;

  /// Turn the values of covered texels and of `others` into codes. Those that are what they were
  /// get the texture's own codes, bit for bit.
  /// \param others other texels that have working values, ascending
  void encode(const std::vector<Index>& others) const;

 private:
  template <class Body>
  void over_tiles(const Body& body) const;
  std::vector<Index> covered_texels(std::size_t begin, std::size_t end,
                                    std::vector<float>& read) const;
  void blend_some(const std::vector<Index>& texels, const std::vector<float>& before,
                  double strength, const std::vector<float>& mask) const;
  void add_detail(const std::vector<Index>& texels, const std::vector<float>& read,
                  const TextureTile& tile, double gain) const;
  void encode_some(const std::vector<Index>& texels, const std::vector<float>& read,
                   const TextureTile& tile) const;
  bool is_as_read(Index texel, const float* read) const;
  float alpha_factor(Index texel, const TextureTile& tile) const;

  const WorkingValues& working_;
  const ConstTexelValues codes_;  ///< of the textures
  TexelValues values_;
};

}  // namespace onmesh
