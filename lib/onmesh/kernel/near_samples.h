// The samples around each target, for what is no sum: percentiles, medians.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "onmesh/kernel/kernel_input.h"

namespace onmesh {

/// Finds them patch by patch, keeping its buffers. One object per thread.
///
/// Faces may hold many more samples than are near: they are parted into cells about as wide as the
/// radius, and only cells that are near a cell of targets are looked at.
class NearSamples {
 public:
  /// Called with a target and the texels of the samples near it, without its own.
  using Visit = std::function<void(const Sample& target, std::span<const Index> texels)>;
  /// How far samples of a target may be, in mesh units.
  using RadiusOf = std::function<double(const Sample& target)>;

  /// Visit the targets of the patch's core faces that have a radius above 0.
  /// \param input colours do not matter
  /// \param largest no radius is larger
  /// \param slack factor of radii, for rounding
  void run(const KernelInput& input, double largest, const RadiusOf& radius_of, double slack,
           const Visit& visit);

  /// A cell's samples as vectors read them: as many floats of each, and a vector more.
  struct CellFloats {
    const float *b1, *b2, *variance;
    const Index* texels;
    std::size_t count;
  };

 private:
  /// Samples of one face that lie close to each other.
  struct Cell {
    Index face;              ///< local
    std::size_t begin, end;  ///< samples
    float b1, b2;            ///< of its middle
    float variance;          ///< of that
    float extent;            ///< from there to the farthest sample
  };
  /// Of all samples, or targets, of some faces, by cells.
  struct Cells {
    std::vector<Cell> cells;
    std::vector<std::size_t> face_cells;  ///< where each face's cells begin, and their end
    std::vector<float> b1, b2, variance;
    std::vector<Index> samples, texels;
  };
  /// Cells that are near those of the targets, in one face.
  struct NearFace {
    Index face;
    std::vector<const Cell*> cells;
  };

  static Cell whole_face(const std::array<double, 3>& lengths);
  void gather(const Patch& patch, const Samples& samples, Index faces, double radius, Cells& cells);
  void add_face(const Patch& patch, const Samples& samples, Index face, double radius,
                Cells& cells);
  void sort_keys(std::uint32_t count);
  void find_faces(const KernelInput& input, Index core_face, double largest);
  void find_cells(const KernelInput& input, const Cell& targets, double largest);
  void find_samples(const KernelInput& input, Index core_face, std::size_t target, double radius);
  bool exponents_at(const KernelInput& input, Index core_face, const std::array<float, 3>& at,
                    float variance, Index face, std::array<float, 3>& corners) const;

  Cells sources_, targets_;
  // Per face of the patch.
  std::vector<float> longest_;  ///< its longest edge
  std::vector<Cell> whole_faces_;
  std::vector<Index> near_faces_;
  std::vector<NearFace> near_;  ///< the first near_count_ are in use
  std::size_t near_count_ = 0;
  std::vector<Index> found_;  ///< the first found_count_
  std::size_t found_count_ = 0;
  std::vector<std::pair<std::uint32_t, Index>> keys_, sorted_;
};

}  // namespace onmesh
