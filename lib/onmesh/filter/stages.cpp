#include "onmesh/filter/stages.h"

#include "onmesh/base/process_memory.h"

namespace onmesh {

void Stages::begin(const char* stage) {
  stage_ = stage;
  start_ = std::chrono::steady_clock::now();
  advance(0);
}

void Stages::advance(double done) const {
  if (progress_) progress_(stage_, done);
}

void Stages::end() {
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
  times_.push_back({stage_, taken.count(), peak_memory_bytes()});
  advance(1);
}

}  // namespace onmesh
