#include "sim/study/table_mo95.h"

namespace dendro::study {
namespace {

std::vector<RowGroup> open_rows() {
  RowGroup group{"", {}, [](const TableContext&, std::vector<TableRow>&) {}};
  const auto add = [&group](const char* id, const char* what, const char* why) {
    group.rows.push_back(claim(id, what, "1"));
    group.rows.back().note = std::string("no figure: ") + why;
  };
  add("MO95-B2", "figures at latitudes 90, 45 and 0 with n = 4",
      "a statement on directions, which tests compare with the rule");
  add("MO95-B5", "a picture must be somewhat coarser than its views",
      "no experiment here varies the picture's size");
  add("MO95-B13", "three views inside of polar triangles, else four",
      "both are implemented; no time was printed for either");
  add("MO95-B14", "z-buffer hardware does not keep several layers", "a statement on other machines");
  add("MO95-B15", "glitches with one layer, none with three", "no number; pictures of a turn show it");
  add("MO95-B16", "no jump when the set of views changes", "no number; pictures of a turn show it");
  add("MO95-B17", "shading once a covered pixel", "a statement on the program, which its phases show");
  add("MO95-B18", "normals in two bytes", "no figure in MO95; tests compare normals with their bytes");
  return {group};
}

/// A setting that no scene of the table takes is the user's mistake.
void check(const TableContext& context) {
  check_level(context);
  check_run(request_of(context, mo95_scene("video-3", {})));
}

}  // namespace

PaperTable mo95_table() {
  std::vector<RowGroup> groups;
  for (const auto make : {mo95_frame_groups, mo95_tree_groups, mo95_processor_groups, open_rows})
    for (RowGroup& group : make()) groups.push_back(std::move(group));
  return grouped_table("MO95", "Rendering Trees from Precomputed Z-Buffer Views, 1995: trees on sgi-4d35",
                       std::move(groups), check);
}

}  // namespace dendro::study
