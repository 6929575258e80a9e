#include <fmt/format.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "sim/base/sha256.h"
#include "sim/study/elf.h"
#include "tests/firmware/mips/shell.h"

namespace dendro::mips {
namespace {

using Json = nlohmann::ordered_json;

/// Of what the machine loads: other sections hold folders of the build.
std::string digest_of(const std::string& path) {
  const study::ElfProgram program = study::read_elf(read_file(path), path);
  std::string bytes = fmt::format("{:08x}", program.entry);
  for (const auto& segment : program.segments) {
    bytes += fmt::format("{:08x}", segment.address);
    bytes.append(segment.bytes.begin(), segment.bytes.end());
  }
  return base::sha256(bytes);
}

struct Program {
  const char *name, *file, *command, *arguments;  ///< `dendro` COMMAND [file, if it is exec] ARGUMENTS
};

const Program kPrograms[] = {
    {"integers", "mips_integers", "exec sgi-4d35", ""},
    {"maths", "mips_maths", "exec sgi-4d35", "-- 30"},
    {"reconstruct", "zbuffer_views_reconstruct", "run",
     "magnolia --set image.width=64 --set image.height=96 --set zbuffer_views.view_width=64 --set zbuffer_views.view_height=128"},
    {"polygons", "zbuffer_views_polygons", "run",
     "magnolia-plain --set zbuffer_views.draw='\"polygons\"' --set object.0.age=6 --set image.width=48 --set image.height=64"},
};

/// From a folder where the program has a name of its own: it lies in memory with its other arguments.
std::int64_t cycles_of(const Program& program) {
  const std::string command = program.command;
  const Ran ran = run(fmt::format("cd {} && cp {} program.elf && {} {} {} --quiet --level cycle --json golden.json {} >/dev/null </dev/null",
                                  scratch(), program_file(program.file), DENDRO, command, command == "run" ? "" : "program.elf",
                                  program.arguments));
  EXPECT_EQ("", ran.errors);
  return Json::parse(read_file(scratch() + "/golden.json"))["cycles"];
}

/// Cycle counts of programs that nobody touched may not change unseen. They hold for the bytes that one compiler made:
/// other bytes are skipped and named. DENDRO_WRITE_GOLDEN=1 writes the file anew.
TEST(MipsGolden, ProgramsOfTheSameBytesTakeTheSameCycles) {
  const std::string monitor = digest_of(std::string(MIPS_FOLDER) + "/monitor.elf");
  Json now{{"compiler", MIPS_COMPILER}, {"monitor", monitor}, {"programs", Json::object()}};
  const bool write = std::getenv("DENDRO_WRITE_GOLDEN") != nullptr;
  const Json golden = write ? Json() : Json::parse(read_file(GOLDEN));
  std::string others;
  if (!write && golden["monitor"] != monitor) others = " monitor";
  for (const Program& program : kPrograms) {
    const std::string digest = digest_of(program_file(program.file));
    if (write) {
      now["programs"][program.name] = {{"digest", digest}, {"cycles", cycles_of(program)}};
    } else if (const Json& kept = golden["programs"][program.name]; kept["digest"] != digest) {
      others += fmt::format(" {}", program.name);
    } else if (others.find("monitor") == std::string::npos) {
      EXPECT_EQ(kept["cycles"].get<std::int64_t>(), cycles_of(program)) << program.name;
    }
  }
  if (write) std::ofstream(GOLDEN) << now.dump(1) << "\n";
  if (!others.empty())
    GTEST_SKIP() << "not compared, since their bytes are not those of " << golden["compiler"].get<std::string>()
                 << " that cycles.json is of:" << others << " (here compiled by " << MIPS_COMPILER << ")";
}

}  // namespace
}  // namespace dendro::mips
