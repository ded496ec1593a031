// The linear systems of the heat method on one patch (heat.cpp solves them).
#pragma once

#include <vector>

#include "onmesh/patches/patch.h"

namespace onmesh::heat {

/// A = L D L^T, L by rows and by columns so that both substitutions only gather. Indices ascend.
/// The first index of a column is its parent in the elimination tree.
struct Factor {
  std::vector<Index> row_begin, row_index, column_begin, column_index;
  std::vector<float> row_value, column_value, inverse_d;
};

/// A face of the split patch. In its plane corner 0 is the origin and corner 1 on the x axis.
struct SplitFace {
  std::array<Index, 3> corner;
  float gx1, gy1, gx2, gy2;  ///< gradients of the hat functions of corners 1 and 2; corner 0: -sum
  float area;                ///< times the face's weight
};

/// The patch split 1 -> 4 by halving its edges, with its factorisations. Lengths are in units of
/// `scale`, split nodes are numbered for a sparse factor. M is the lumped mass matrix, L the cotan
/// Laplacian, positive semidefinite, t the time step.
struct LinearSystems {
  Index size = 0;
  double scale = 1;               ///< mesh units per unit
  std::vector<Index> split_node;  ///< of each patch node
  std::vector<Index> component;   ///< of each patch node: the component's first patch node
  std::vector<SplitFace> faces;
  Factor heat, heat4, poisson;  ///< M + t L, M + 4 t L, and L with one node of a component pinned
};

/// The systems of steps I and III of the heat method (Crane, Weischedel & Wardetzky 2013), with a
/// border that lets part of the heat out.
/// \param weights per face of the patch: how many layers of surface it stands for; empty = 1 each
/// \param reach mesh units; the time step keeps heat representable as far as that
/// \pre the patch has faces and an edge of positive length
/// \throw NumericError if a matrix cannot be factorised
LinearSystems make_linear_systems(const Patch& patch, const std::vector<float>& weights,
                                  double reach);

}  // namespace onmesh::heat
