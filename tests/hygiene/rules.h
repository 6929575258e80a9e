#pragma once

#include <map>
#include <string>

#include "tests/hygiene/repository.h"

/// The rules of docs/architecture.md. Each looks at a repository and says what breaks it.
namespace dendro::hygiene {

// sources.cpp
Problems presets_without_source(const Repository& repository);
Problems unresolved_keys(const Repository& repository);
Problems unlisted_or_unused_deviations(const Repository& repository);
/// Every section of docs/deviations.md answers all questions, names tests that exist, and the parameters that rest on it.
Problems incomplete_deviations(const Repository& repository);

// arrows.cpp
Problems systemc_outside_its_places(const Repository& repository);
Problems forbidden_includes(const Repository& repository);
Problems firmware_known_by_name(const Repository& repository);
Problems world_read_by_models(const Repository& repository);

// files.cpp
Problems oversized_sources(const Repository& repository);
/// Sources above the soft limit: a warning only.
Problems long_sources(const Repository& repository);
Problems oversized_data(const Repository& repository);
Problems machine_traces(const Repository& repository);
Problems headers_without_pragma_once(const Repository& repository);

// pages.cpp
Problems broken_links(const Repository& repository);
Problems unreachable_pages(const Repository& repository);
Problems named_paths_that_do_not_exist(const Repository& repository);

// parameter_table.cpp
/// The page with its generated part made anew from the presets. `page` is "docs/machines/NAME.md".
std::string with_parameter_table(const Repository& repository, const std::string& page);
/// "docs/machines/NAME.md" for every machine that has presets.
std::vector<std::string> machine_pages(const Repository& repository);

}  // namespace dendro::hygiene
