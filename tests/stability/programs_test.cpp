#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>

#include "firmware/lib/workstation_rig.h"
#include "firmware/zbuffer_views/stability/program_files.h"
#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/rds3000.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "sim/study/algorithms.h"
#include "sim/study/stability.h"

// N-B1 to N-B8 on programs with one fault each, the smallest that the case is there to find.

namespace dendro::study {
namespace {

using stability::Files;
using zbuffer_views::ViewsFile;

/// Turns every c.lt.s and c.lt.d of a program into c.le: "nearer" becomes "not farther". Returns how many.
int less_becomes_not_greater(std::string& elf) {
  int turned = 0;
  for (std::size_t at = 0; at + 4 <= elf.size(); at += 4) {
    std::uint32_t word = 0;
    for (std::size_t i = 0; i < 4; ++i) word = word << 8 | static_cast<unsigned char>(elf[at + i]);
    if ((word & 0xFFC007FFu) != 0x4600003Cu) continue;
    elf[at + 3] = 0x3E;
    ++turned;
  }
  return turned;
}

template <typename Change>
void change_views(std::vector<std::uint8_t>& file, const Change& change) {
  ViewsFile views = ViewsFile::parse({file.begin(), file.end()});
  change(views);
  const std::string bytes = views.bytes();
  file.assign(bytes.begin(), bytes.end());
}

void add_to_single(std::vector<std::uint8_t>& file, std::size_t at, float more) {
  std::uint32_t word = 0;
  for (std::size_t i = 0; i < 4; ++i) word = word << 8 | file[at + i];
  float value;
  std::memcpy(&value, &word, sizeof value);
  value += more;
  std::memcpy(&word, &value, sizeof word);
  for (std::size_t i = 0; i < 4; ++i) file[at + i] = static_cast<std::uint8_t>(word >> (24 - 8 * i));
}

/// What is wrong with a program: with its instructions, what it reads, or what it says.
struct Fault {
  const char *id, *name, *program;
  const char* row;  ///< part of what the row says that has to fail
  void (*instructions)(std::string& elf) = nullptr;
  void (*input)(Files& files) = nullptr;
  void (*output)(Files& files, std::string& printed) = nullptr;
};

void turn_comparisons(std::string& elf) { ASSERT_GT(less_becomes_not_greater(elf), 0); }

const Fault kFaults[] = {
    {"N-B1", "TiesLost", "zbuffer_views_precompute", "table's", nullptr, nullptr,
     [](Files&, std::string& printed) {
       if (const std::size_t at = printed.find("1 7 11 13 11 7 1"); at != std::string::npos) printed[at + 2] = '6';
     }},
    {"N-B2", "NeighboursSwapped", "zbuffer_views_reconstruct", "off every border", nullptr,
     [](Files& files) { change_views(files["from"], [](ViewsFile& v) { std::swap(v.layers[1], v.layers[2]); }); }},
    {"N-B3", "EqualityJoins", "zbuffer_views_precompute", "peel: samples that are not greedy", nullptr,
     [](Files& files) { add_to_single(files["job"], offsetof(zbv_job, threshold), 0x1p-20f); }},
    {"N-B4", "HigherNumberWins", "zbuffer_views_reconstruct", "lowest number", turn_comparisons},
    {"N-B5", "LongitudesDoNotWrap", "zbuffer_views_precompute", "bytes that are not", nullptr, nullptr,
     [](Files& files, std::string&) {
       change_views(files["to"], [](ViewsFile& v) {
         for (auto& view : v.layers)
           for (auto& layer : view)
             for (std::uint8_t& byte : layer.longitude) byte = byte == 0 ? 255 : byte;
       });
     }},
    {"N-B6", "BiasOfOneStep", "zbuffer_views_reconstruct", "floor(x + 1/2)", nullptr,
     [](Files& files) { add_to_single(files["job"], offsetof(zbv_job, centre_x), -0x1p-18f); }},
    {"N-B7", "NearIsDrawn", "zbuffer_views_reconstruct", "not beyond `near`", turn_comparisons},
    {"N-B8", "LightHalfAPixelOff", "zbuffer_views_reconstruct", "60 degrees: least threshold", nullptr,
     [](Files& files) { change_views(files["from"], [](ViewsFile& v) { v.views[0].x0 += v.facts.pitch / 2; }); }},
};

class FaultyProgram : public stability::Rig, public stability::WorkstationRig {
 public:
  FaultyProgram(const stability::Rig& sound, const Fault& fault)
      : sound_(sound), workstation_(dynamic_cast<const WorkstationRig&>(sound)), fault_(fault) {}

  std::unique_ptr<Rig> with(const std::map<std::string, std::int64_t>& p) const override { return sound_.with(p); }
  lib::IgcPrograms igc_programs(const std::vector<std::string>& p) const override { return sound_.igc_programs(p); }
  std::vector<std::vector<std::int64_t>> tree(const stability::TreeDrive& drive, const std::vector<stability::TreeStream>& streams,
                                              const std::vector<stability::TreePixel>& pixels) const override {
    return sound_.tree(drive, streams, pixels);
  }
  lib::ProgramImage program(const std::string& path) const override { return sound_.program(path); }
  void run(const std::function<void(HostPort&)>& host_program,
           const std::function<void(const MachineView&)>& inspect) const override {
    sound_.run(host_program, inspect);
  }

  std::string program_bytes(const std::string& program) const override { return workstation_.program_bytes(program); }
  std::string exec_bytes(const std::string& program, const std::string& bytes, const std::vector<std::string>& arguments,
                         Files& files) const override {
    if (program != fault_.program) return workstation_.exec_bytes(program, bytes, arguments, files);
    std::string elf = bytes;
    if (fault_.instructions != nullptr) fault_.instructions(elf);
    if (fault_.input != nullptr) fault_.input(files);
    std::string printed = workstation_.exec_bytes(program, elf, arguments, files);
    if (fault_.output != nullptr) fault_.output(files, printed);
    return printed;
  }

 private:
  const Rig& sound_;
  const WorkstationRig& workstation_;
  const Fault& fault_;
};

class FaultyPrograms : public ::testing::TestWithParam<Fault> {};

TEST_P(FaultyPrograms, TheRowThatMeasuresTheFaultFailsAndSaysWhereItCan) {
  const Fault& fault = GetParam();
  std::vector<StabilitySuite> suites = stability_suites();
  for (StabilitySuite& suite : suites)
    for (stability::Case& one : suite.cases)
      one.run = [sound = one.run, &fault](const stability::Rig& rig, std::uint64_t seed) {
        return sound(FaultyProgram(rig, fault), seed);
      };
  StabilityOptions options;
  options.cases = {fault.id};
  const Catalogue catalogue = {{rds3000::rds3000_type(), pixel_planes::pixel_planes_type(), sgi_4d35::sgi_4d35_type()},
                               algorithms(), ""};
  const auto results = run_stability(catalogue, suites, options, nullptr);
  ASSERT_EQ(1u, results.size());
  bool failed = false;
  for (const stability::Row& row : results[0].rows) {
    if (row.what.find(fault.row) == std::string::npos) continue;
    if (row.pass()) continue;
    failed = true;
    // A count has a first place; a threshold is of a whole picture.
    if (row.bound == 0) {
      EXPECT_NE("", row.where) << row.what;
    }
  }
  EXPECT_TRUE(failed) << stability_text(results);
}

INSTANTIATE_TEST_SUITE_P(Cases, FaultyPrograms, ::testing::ValuesIn(kFaults), [](const auto& tested) {
  return "NB" + std::string(tested.param.id).substr(3) + tested.param.name;
});

}  // namespace
}  // namespace dendro::study
