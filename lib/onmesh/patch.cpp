#include "onmesh/patch.h"
