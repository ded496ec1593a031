#include "onmesh/mesh_io.h"
