#include "onmesh/ply.h"
