#include "onmesh/node_mesh.h"
