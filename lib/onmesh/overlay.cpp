#include "onmesh/overlay.h"
