#include "onmesh/image.h"
