// The stages of filter and fill: their times for the report, their progress for the user.
#pragma once

#include <chrono>
#include <vector>

#include "onmesh/base/progress.h"
#include "onmesh/filter/report.h"

namespace onmesh {

/// Notes the time between begin() and end() as a stage of a report, and announces stages to the
/// user. One at a time.
class Stages {
 public:
  /// \pre both outlive this
  Stages(std::vector<StageTime>& times, const Progress& progress)
      : times_(times), progress_(progress) {}

  void begin(const char* stage);
  /// \param done share of the stage, 0 to 1
  void advance(double done) const;
  void end();

 private:
  std::vector<StageTime>& times_;
  const Progress& progress_;
  const char* stage_ = "";
  std::chrono::steady_clock::time_point start_;
};

}  // namespace onmesh
