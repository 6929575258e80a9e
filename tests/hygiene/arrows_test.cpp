#include <gtest/gtest.h>

#include "tests/hygiene/expect_none.h"
#include "tests/hygiene/rules.h"

namespace dendro::hygiene {
namespace {

TEST(SystemC, StaysInItsPlaces) { expect_none(systemc_outside_its_places(repository())); }

TEST(SystemC, IsFoundElsewhere) {
  const auto problems = [](const std::string& path, const std::string& text) {
    return systemc_outside_its_places({{{path, text}}}).size();
  };
  const std::string include = "#include <systemc>\n";
  EXPECT_EQ(1u, problems("models/parts/x/x.h", include));
  EXPECT_EQ(1u, problems("sim/base/a.cpp", "sc_core::sc_time t;\n"));
  EXPECT_EQ(1u, problems("firmware/a/a.cpp", "#include \"tlm\"\n"));
  EXPECT_EQ(0u, problems("models/parts/x/x_shell.h", include));
  EXPECT_EQ(0u, problems("models/machines/m/m.cpp", include));
}

TEST(Arrows, PointOneWay) { expect_none(forbidden_includes(repository())); }

TEST(Arrows, AWrongOneIsFound) {
  const auto problems = [](const std::string& path, const std::string& include) {
    return forbidden_includes({{{path, "#include \"" + include + "\"\n"}}}).size();
  };
  EXPECT_EQ(1u, problems("models/machines/a/a.h", "models/machines/b/b.h"));
  EXPECT_EQ(0u, problems("models/machines/a/a.h", "models/machines/a/b.h"));
  EXPECT_EQ(1u, problems("models/machines/a/a.h", "sim/config/preset.h"));
  EXPECT_EQ(0u, problems("models/machines/a/a.h", "sim/config/parameters.h"));
  EXPECT_EQ(1u, problems("models/parts/a/a.h", "models/machines/machine.h"));
  EXPECT_EQ(1u, problems("models/parts/a/a.h", "models/parts/b/b_shell.h"));
  EXPECT_EQ(1u, problems("models/parts/a/a.h", "sim/tlm/a.h"));
  EXPECT_EQ(0u, problems("models/parts/a/a_shell.h", "sim/tlm/a.h"));
  EXPECT_EQ(1u, problems("sim/base/a.h", "sim/config/a.h"));
  EXPECT_EQ(1u, problems("sim/scene/a.h", "models/parts/a/a.h"));
  EXPECT_EQ(1u, problems("sim/study/a.h", "models/machines/a/a.h"));
  EXPECT_EQ(1u, problems("sim/study/a.h", "sim/app/a.h"));
  EXPECT_EQ(1u, problems("firmware/tools/a.h", "models/parts/a/a.h"));
  EXPECT_EQ(0u, problems("firmware/tools/a.h", "models/parts/a/a_isa.h"));
  EXPECT_EQ(1u, problems("firmware/a/host/a.h", "models/parts/a/a_isa.h"));
  EXPECT_EQ(1u, problems("firmware/a/reference/a.h", "firmware/b/host/a.h"));
  EXPECT_EQ(1u, problems("firmware/a/reference/a.h", "sim/study/a.h"));
  EXPECT_EQ(1u, problems("sim/base/a.cpp", "a.h"));
  EXPECT_EQ(1u, problems("sim/app/a.cpp", "tests/support/a.h"));
}

TEST(Firmware, IsUnknownToModelsAndSimulator) { expect_none(firmware_known_by_name(repository())); }

TEST(Firmware, KnownByNameIsFound) {
  Repository r = {{{"firmware/half_x/README.md", ""}, {"models/a.cpp", "if (name == \"half_x\") {}\n"}}};
  EXPECT_EQ(1u, firmware_known_by_name(r).size());
  r.files = {{"firmware/half_x/README.md", ""}, {"sim/study/a.cpp", "half_x\n"}, {"sim/scene/a.h", "// \"half_x\"\n"}};
  EXPECT_EQ(0u, firmware_known_by_name(r).size());
}

TEST(Models, DoNotLookAtTheWorld) { expect_none(world_read_by_models(repository())); }

TEST(Models, ThatDoAreFound) {
  for (const char* text : {"std::getenv(\"A\");", "std::chrono::system_clock::now();", "std::random_device r;",
                           "std::ifstream in(path);", "#include <toml++/toml.h>"})
    EXPECT_EQ(1u, world_read_by_models({{{"models/parts/a/a.cpp", text}}}).size()) << text;
  EXPECT_EQ(0u, world_read_by_models({{{"sim/study/a.cpp", "std::getenv(\"A\");"}}}).size());
}

}  // namespace
}  // namespace dendro::hygiene
