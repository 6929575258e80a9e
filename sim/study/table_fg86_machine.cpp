#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "firmware/half_space/host/hulls_layout.h"
#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/check.h"
#include "sim/base/embedded.h"
#include "sim/study/table_fg86.h"

namespace dendro::study {
namespace {

constexpr const char* kDocumented = "arithmetic: documented inputs of the model";

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// How a mode of the image memory is addressed by a program: pixels a side, the step of the address
/// registers, the name of the access.
struct Mode {
  int side;
  int step;
  const char* access;
};

constexpr Mode kLores = {512, 2, "lores"}, kHires = {1024, 1, "hires"};

/// Ones go into every pixel in one mode; then the bits of the first pixel and the pixels equal to it are
/// counted in the other. Results: scratch words 0 (pixels) and 1 (bits of a pixel).
std::string memory_program(const Mode& fill, const Mode& count) {
  const auto sweep = [](const Mode& mode, const std::string& name, const std::string& body) {
    return fmt::format(
        "  y = 0;\n{0}_line:\n  bus_y = y;\n  x = 0;\n  for {1} {{\n    bus_x = x;\n{3}    x = x + {2};\n"
        "  }}\n  y = y + {2};\n  y - {4} -> flags;\n  if (!zero) goto {0}_line;\n",
        name, mode.side, mode.step, body, mode.side * mode.step);
  };
  return "scratch pixels[1] @ 0;\nscratch bits[1] @ 1;\nreg x = r0;\nreg y = r1;\nreg n = r2;\nreg p = r3;\n"
         "reg first = r4;\nentry start;\nstart:\n  n = -1;\n  bus_data = n;\n" +
         sweep(fill, "fill", fmt::format("    write {};\n", fill.access)) +
         fmt::format("  x = 0;\n  bus_x = x;\n  bus_y = x;\n  read {};\n  first = bus;\n  n = 0;\n",
                     count.access) +
         sweep(count, "count",
               fmt::format(
                   "    read {};\n    p = bus;\n    p - first -> flags;\n    if (zero) {{ n = n + 1; }}\n",
                   count.access)) +
         "  pixels[0] = n;\n  n = 0;\n  p = 1;\n  for 32 {\n    first & p -> flags;\n    if (!zero) { n = n "
         "+ 1; }\n"
         "    p = p + p;\n  }\n  bits[0] = n;\n  halt;\n";
}

struct Memory {
  double pixels = 0, bits = 0;  ///< of one pixel
};

/// What a mode's program finds of the ones that the other's has left.
Memory measure_memory(const TableContext& context, const Mode& fill, const Mode& count) {
  const ExecOutput output =
      exec_text(context, "image_memory.gia", memory_program(fill, count), {}, "function", {{0, 2}});
  return {static_cast<double>(output.dumps.at(0).at(0)), static_cast<double>(output.dumps.at(0).at(1))};
}

void fill_memory(const TableContext& context, std::vector<TableRow>& rows) {
  const Memory lores = measure_memory(context, kHires, kLores),
               hires = measure_memory(context, kLores, kHires);
  const double bits = std::floor(lores.bits / 3);
  set_single(rows[0], std::exp2(bits));
  rows[0].note = fmt::format(
      "{:g} bits a pixel, counted by a microprogram, in three; the programs use {} bits each; two registers "
      "of {:g} bits "
      "would have {:g} depths",
      lores.bits, half_space::kHullBits, std::floor(lores.bits / 2), std::exp2(std::floor(lores.bits / 2)));
  set_single(rows[1], lores.pixels * lores.bits);
  rows[1].note = fmt::format("{:.0f} pixels of {:g} bits hold the ones that were written in the other mode",
                             lores.pixels, lores.bits);
  set_single(rows[2], hires.pixels * hires.bits);
  rows[2].note =
      fmt::format("{:.0f} pixels of {:g} bits; all ones written in the other mode", hires.pixels, hires.bits);
}

void fill_sizes(const TableContext& context, std::vector<TableRow>& rows) {
  const RunRequest request = request_of(context, {"icosahedron", {}, "function", {}});
  const auto words = [&](const char* key) {
    return static_cast<double>(integer_of(request.preset.parameters, key));
  };
  set_single(rows[0], words("processor.control_store_words") * 64 / 8);
  set_single(rows[1], words("processor.scratch_words") * 32 / 8);
  for (TableRow& row : rows) row.note = kDocumented;
}

/// 16x16 multiplication: from the word that starts it to the first that could take the product.
void fill_multiply(const TableContext& context, std::vector<TableRow>& rows) {
  const std::string text =
      "reg t = r0;\nentry start;\nstart:\n  t = 3;\n  mul_x = t;\n  mul_y = t;\nmark_begin:\n  mul signed;\n"
      "  if (product_ready) goto mark_end;\n  if (product_ready) goto mark_end;\n  if (product_ready) goto "
      "mark_end;\n"
      "  if (product_ready) goto mark_end;\n  if (product_ready) goto mark_end;\n  if (product_ready) goto "
      "mark_end;\n"
      "mark_end:\n  halt;\n";
  // A taken branch would be counted with the product it waited for.
  const ExecOutput output = exec_text(context, "multiply.gia", text, {"processor.taken_branch_ticks=0"});
  const auto& marks = output.object.marks;
  DENDRO_CHECK(marks.size() == 2, "{} marks", marks.size());
  const double ticks = static_cast<double>(marks[1].second - marks[0].second - 1);
  set_single(rows[0], ticks / output.object.clock_hz * 1e9);
  rows[0].note = fmt::format("{:g} ticks of {:g} ns, measured by a microprogram; {}", ticks,
                             1e9 / output.object.clock_hz, kDocumented);
}

constexpr const char* kFixedMultiply = "firmware/half_space/stability/fixed_multiply.gia";
constexpr int kFixedPairs = 64;
constexpr std::uint64_t kFixedSeed = 1986;

/// The program with pairs of random numbers in its scratchpad.
std::string fixed_multiply_text() {
  const std::string* source = base::embedded_file(kFixedMultiply);
  DENDRO_CHECK(source != nullptr, "{}", kFixedMultiply);
  std::string text = *source + fmt::format("data 0 = {{{}}};\ndata 1024 = {{", kFixedPairs);
  std::mt19937_64 random(kFixedSeed);
  for (int i = 0; i < 2 * kFixedPairs; ++i)
    text += fmt::format("{}{:#x}", i == 0 ? "" : ", ", static_cast<std::uint32_t>(random()));
  return text + "};\n";
}

void fill_fixed_multiply(const TableContext& context, std::vector<TableRow>& rows) {
  const ExecOutput output = exec_text(context, kFixedMultiply, fixed_multiply_text());
  double begin = 0, products = 0, pairs = 0, sum = 0, least = INFINITY, most = 0;
  for (const auto& [name, tick] : output.object.marks) {
    if (starts_with(name, "mark_product")) ++products;
    if (name == "mark_begin") begin = static_cast<double>(tick);
    if (name != "mark_end") continue;
    const double ticks = static_cast<double>(tick) - begin;
    ++pairs, sum += ticks, least = std::min(least, ticks), most = std::max(most, ticks);
  }
  DENDRO_CHECK(pairs == kFixedPairs, "{} products", pairs);
  set_single(rows[0], products / pairs);
  rows[0].note = fmt::format("counted over {} products of random numbers; N-A10 checks them", kFixedPairs);
  set_range(rows[1], sum / pairs, least, most);
  rows[1].note =
      "8 are the multiplier's own ticks; operands, sums and the unsigned low halves, which a signed unit "
      "takes for "
      "negative, take the rest; interval over random numbers";
}

/// Words between a depth_step label and the next label that add a register onto another in place, the pixel
/// address aside: the additions that a pixel's depth costs.
std::set<std::uint32_t> depth_additions(const tools::Ucode& program) {
  using namespace bps32;
  std::set<std::uint32_t> counted;
  for (const auto& [name, start] : program.symbols) {
    if (!starts_with(name, "depth_step")) continue;
    std::uint32_t end = static_cast<std::uint32_t>(program.words.size());
    for (const auto& [other, at] : program.symbols)
      if (at > start) end = std::min(end, at);
    for (std::uint32_t at = start; at < end; ++at) {
      const std::uint64_t word = program.words[at];
      const bool adds =
          get(word, kFunc) == kRPlusS && get(word, kI0) == 0 && get(word, kOeb) == 0 && get(word, kEa) == 0;
      const unsigned dest = get(word, kDest);
      const bool in_place = dest == kRam || dest == kRamAlso;
      if (adds && in_place && get(word, kYdst) != kYBusX) counted.insert(at);
    }
  }
  return counted;
}

/// The words that add and the loops that they are in, of the program as it is packed.
std::map<std::uint32_t, std::string> count_additions(const RunRequest& request) {
  const tools::Ucode program = half_space_program(request.preset.parameters);
  std::map<std::uint32_t, std::string> counted;
  for (const auto& [name, at] : program.symbols)
    if (starts_with(name, "depth_step")) counted[at] = "visit " + std::to_string(at);
  for (const std::uint32_t at : depth_additions(program)) counted[at] += " adds " + std::to_string(at);
  return counted;
}

double additions_per_visit(const stats::RunObject& run) {
  double added = 0, visits = 0;
  for (const auto& [name, count] : run.executions) {
    if (name.find("adds") != std::string::npos) added += static_cast<double>(count);
    if (starts_with(name, "visit")) visits += static_cast<double>(count);
  }
  DENDRO_CHECK(visits > 0, "no pixel was visited");
  return added / visits;
}

void fill_additions(const TableContext& context, std::vector<TableRow>& rows) {
  std::vector<SceneRun> runs;
  for (const char* pack : {"none", "full"})
    runs.push_back({"icosahedron",
                    {fmt::format("parameters.microcode.pack=\"{}\"", pack)},
                    "function",
                    count_additions});
  std::vector<double> added;
  for (const Outcome& outcome : compared_runs(context, runs, "FG86 additions"))
    added.push_back(additions_per_visit(from_bytes(outcome.value()).object));
  set_range(rows[0], added[0], std::min(added[0], added[1]), std::max(added[0], added[1]));
  rows[0].note =
      "executions of the microwords that add to a depth, per pixel visited with a depth; packed and not";
}

}  // namespace

std::vector<RowGroup> fg86_machine_groups() {
  return {
      {"microprograms that write ones in one mode of the image memory and count them in the other",
       {claim("FG86-A1", "depths of each of three registers", "1", 256.0),
        claim("FG86-A2a", "image memory as 512x512x24", "bit", 512.0 * 512 * 24),
        claim("FG86-A2b", "image memory as 1024x1024x6", "bit", 1024.0 * 1024 * 6)},
       fill_memory},
      {"a microprogram that waits for a product",
       {claim("FG86-A3", "signed 16x16 multiplication, 2 cycles of 200 ns", "ns", 400.0)},
       fill_multiply},
      {"",
       {claim("FG86-A4a", "control store, 4K words of 64 bits", "B", 4096.0 * 64 / 8),
        claim("FG86-A4b", "scratchpad, 8K words of 32 bits", "B", 8192.0 * 32 / 8)},
       fill_sizes},
      {"a microprogram that multiplies 16.16 numbers",
       {claim("FG86-A5a", "16x16 multiplications of a 16.16 product", "1", 4.0,
              "the paper gives the number format; 4 follow from a 16-bit unit"),
        claim("FG86-A5b", "time of a 16.16 product", "tick", 8.0, "4 products of 2 cycles, nothing else")},
       fill_fixed_multiply},
      {"the icosahedron at level function, microcode packed and not",
       {claim("FG86-A17", "additions for the depth of one pixel", "1", 1.0)},
       fill_additions}};
}

}  // namespace dendro::study
