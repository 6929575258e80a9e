#include <fmt/format.h>
#include <gmpxx.h>

#include <array>

#include "firmware/half_space/stability/support.h"

// N-A10, by microcode on the machine's multiplier.

namespace dendro::half_space {
namespace {

using stability::Bound;

constexpr const char* kProgram = "firmware/half_space/stability/multiplier.gia";
constexpr const char* kFixedProgram = "firmware/half_space/stability/fixed_multiply.gia";
constexpr std::size_t kBatch = 1024, kFixedBatch = 512;
constexpr int kRandomPairs = 4096;

constexpr std::uint16_t kCorners[] = {0x0000, 0x0001, 0x0002, 0x0003, 0x00FF, 0x0100, 0x0FFF, 0x1000,
                                      0x1001, 0x3FFF, 0x4000, 0x5555, 0x7FFE, 0x7FFF, 0x8000, 0x8001,
                                      0x8002, 0xAAAA, 0xBFFF, 0xC000, 0xF000, 0xFF00, 0xFFFE, 0xFFFF};

using Pair = std::pair<std::uint16_t, std::uint16_t>;
constexpr std::array<const char*, 4> kResults = {"signed product", "unsigned product",
                                                 "signed product rounded down to 2^16",
                                                 "signed product rounded to the nearest 2^16"};

std::array<std::uint32_t, 4> exact(const Pair& pair) {
  const mpz_class x(static_cast<std::int16_t>(pair.first)), y(static_cast<std::int16_t>(pair.second));
  const mpz_class ux(pair.first), uy(pair.second);
  const mpz_class modulus = mpz_class(1) << 32;
  const auto word = [&](const mpz_class& value) {
    mpz_class low;
    mpz_fdiv_r(low.get_mpz_t(), value.get_mpz_t(), modulus.get_mpz_t());
    return static_cast<std::uint32_t>(low.get_ui());
  };
  const mpz_class product = x * y, nearest = product + 0x8000;
  mpz_class down, rounded;
  mpz_fdiv_q_2exp(down.get_mpz_t(), product.get_mpz_t(), 16);
  mpz_fdiv_q_2exp(rounded.get_mpz_t(), nearest.get_mpz_t(), 16);
  return {word(product), word(mpz_class(ux * uy)), word(down), word(rounded)};
}

std::vector<Pair> pairs(std::uint64_t seed) {
  std::vector<Pair> all;
  for (const std::uint16_t x : kCorners)
    for (const std::uint16_t y : kCorners) all.emplace_back(x, y);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<unsigned> word(0, 0xFFFF);
  for (int i = 0; i < kRandomPairs; ++i) {
    const auto x = static_cast<std::uint16_t>(word(random));
    all.emplace_back(x, static_cast<std::uint16_t>(word(random)));
  }
  return all;
}

/// Words of all results, four a pair.
std::vector<std::uint32_t> on_machine(const stability::Rig& rig, const std::vector<Pair>& pairs) {
  const lib::ProgramImage image = rig.program(kProgram);
  std::vector<std::uint32_t> results;
  rig.run(
      [&](HostPort& host) {
        lib::RdsDriver driver(host);
        driver.load_program(image);
        for (std::size_t at = 0; at < pairs.size(); at += kBatch) {
          std::vector<std::uint32_t> words;
          for (std::size_t i = at; i < std::min(at + kBatch, pairs.size()); ++i)
            words.push_back(std::uint32_t{pairs[i].first} | std::uint32_t{pairs[i].second} << 16);
          driver.write_scratch(image.scratch.at("count").address, {static_cast<std::uint32_t>(words.size())});
          driver.write_scratch(image.scratch.at("pairs").address, words);
          driver.start(image.entry);
          driver.wait();
          const auto got = driver.read_scratch(image.scratch.at("results").address, 4 * words.size());
          results.insert(results.end(), got.begin(), got.end());
        }
      },
      [](const MachineView&) {});
  return results;
}

using Factors = std::pair<std::uint32_t, std::uint32_t>;

/// Numbers in 16.16 whose halves are corners, and random ones.
std::vector<Factors> factors(std::uint64_t seed) {
  std::mt19937_64 random(seed + 1);
  std::vector<Factors> all;
  const auto corner = [&] { return std::uint32_t{kCorners[random() % std::size(kCorners)]}; };
  for (int i = 0; i < kRandomPairs; ++i) {
    const std::uint32_t a = corner() << 16 | corner(), b = corner() << 16 | corner();
    all.emplace_back(a, b);
    all.emplace_back(static_cast<std::uint32_t>(random()), static_cast<std::uint32_t>(random()));
  }
  return all;
}

/// Products in 16.16, rounded down, modulo 2^32.
std::vector<std::uint32_t> fixed_on_machine(const stability::Rig& rig, const std::vector<Factors>& all) {
  const lib::ProgramImage image = rig.program(kFixedProgram);
  std::vector<std::uint32_t> results;
  rig.run(
      [&](HostPort& host) {
        lib::RdsDriver driver(host);
        driver.load_program(image);
        for (std::size_t at = 0; at < all.size(); at += kFixedBatch) {
          const std::size_t count = std::min(kFixedBatch, all.size() - at);
          std::vector<std::uint32_t> words;
          for (std::size_t i = at; i < at + count; ++i)
            words.insert(words.end(), {all[i].first, all[i].second});
          driver.write_scratch(image.scratch.at("count").address, {static_cast<std::uint32_t>(count)});
          driver.write_scratch(image.scratch.at("pairs").address, words);
          driver.start(image.entry);
          driver.wait();
          const auto got = driver.read_scratch(image.scratch.at("results").address, count);
          results.insert(results.end(), got.begin(), got.end());
        }
      },
      [](const MachineView&) {});
  return results;
}

stability::Row fixed_row(const stability::Rig& rig, std::uint64_t seed) {
  const std::vector<Factors> all = factors(seed);
  const std::vector<std::uint32_t> results = fixed_on_machine(rig, all);
  Tally tally;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const mpz_class product = mpz_class(static_cast<std::int32_t>(all[i].first)) *
                              mpz_class(static_cast<std::int32_t>(all[i].second));
    mpz_class down;
    mpz_fdiv_q_2exp(down.get_mpz_t(), product.get_mpz_t(), 16);
    mpz_fdiv_r_2exp(down.get_mpz_t(), down.get_mpz_t(), 32);
    if (results[i] != down.get_ui())
      tally.fault(fmt::format("step {}: 0x{:08x} times 0x{:08x} is 0x{:08x}, not 0x{:08x}", i, all[i].first,
                              all[i].second, results[i], down.get_ui()));
  }
  return {"N-A10",
          fmt::format("16.16 product of four signed ones, {} pairs", all.size()),
          static_cast<double>(tally.count),
          0,
          "products",
          "gmp",
          Bound::kAtMost,
          tally.first};
}

}  // namespace

stability::Result multiplier(const stability::Rig& rig, std::uint64_t seed) {
  const std::vector<Pair> all = pairs(seed);
  const std::vector<std::uint32_t> results = on_machine(rig, all);
  std::array<Tally, 4> tallies;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto wanted = exact(all[i]);
    for (std::size_t k = 0; k < wanted.size(); ++k)
      if (results[4 * i + k] != wanted[k])
        tallies[k].fault(fmt::format("step {}: 0x{:04x} times 0x{:04x} is 0x{:08x}, not 0x{:08x}", i,
                                     all[i].first, all[i].second, results[4 * i + k], wanted[k]));
  }
  stability::Result result;
  for (std::size_t k = 0; k < tallies.size(); ++k)
    result.rows.push_back({"N-A10", fmt::format("{}, {} pairs", kResults[k], all.size()),
                           static_cast<double>(tallies[k].count), 0, "products", "gmp", Bound::kAtMost,
                           tallies[k].first});
  result.rows.push_back(fixed_row(rig, seed));
  return result;
}

}  // namespace dendro::half_space
