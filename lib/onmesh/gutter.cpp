#include "onmesh/gutter.h"
