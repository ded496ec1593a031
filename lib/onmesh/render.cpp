#include "onmesh/render.h"
