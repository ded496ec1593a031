#include "onmesh/triangle_mesh.h"
