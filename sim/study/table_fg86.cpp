#include "sim/study/table_fg86.h"

#include <optional>

#include "sim/base/error.h"

namespace dendro::study {
namespace {

/// A setting that every scene of the table refuses is the user's mistake; one that some take costs the rows
/// of the others.
void check(const TableContext& context) {
  check_level(context);
  std::optional<UserError> first;
  for (const char* scene : {"icosahedron", "figure5"}) try {
      check_run(request_of(context, {scene, {}, "", {}}));
      return;
    } catch (const UserError& error) {
      if (!first) first = error;
    }
  throw *first;
}

}  // namespace

PaperTable fg86_table() {
  std::vector<RowGroup> groups;
  for (const auto make : {fg86_time_groups, fg86_machine_groups, fg86_growth_groups, fg86_hull_groups,
                          fg86_surface_groups, fg86_texture_groups, fg86_tree_groups, fg86_planes_groups,
                          fg86_texels_groups, fg86_open_groups})
    for (RowGroup& group : make()) groups.push_back(std::move(group));
  return grouped_table("FG86", "The Stochastic Modelling of Trees, 1986: half-space trees on rds3000 and pixel-planes", std::move(groups), check);
}

}  // namespace dendro::study
