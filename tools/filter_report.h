// What onmesh filter says: as JSON, and as text for people.
#pragma once

#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "onmesh/filter/filter.h"

namespace onmesh::tools {

nlohmann::json stages_json(const std::vector<StageTime>& stages);
nlohmann::json to_json(const FilterPlan& plan);
/// Warnings are left out: the caller has some of its own.
nlohmann::json to_json(const FilterReport& report);

void print_plan(const FilterPlan& plan, const std::vector<Image>& textures, std::ostream& out);
/// \param seconds for the whole command
void print_summary(const FilterReport& report, double seconds, std::ostream& out);

}  // namespace onmesh::tools
