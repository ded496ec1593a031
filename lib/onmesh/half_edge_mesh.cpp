#include "onmesh/half_edge_mesh.h"
