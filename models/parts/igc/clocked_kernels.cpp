#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/parts/igc/clocked_kernels.cpp"
#include <hwy/foreach_target.h>
// Highway includes this file once more for every kind of vector, so what follows has no #pragma once.
#include <hwy/highway.h>

#include <algorithm>

#include "models/parts/igc/clocked_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace dendro::igc {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Vectors = hn::ScalableTag<std::uint64_t>;
using Single = hn::CappedTag<std::uint64_t, 1>;
using Word = std::uint64_t;

/// Calls step(tag, i) for i over `words` words, a vector at a time and the rest singly.
template <class Step>
HWY_ATTR void over(std::size_t words, const Step& step) {
  const Vectors d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t i = 0;
  for (; i + lanes <= words; i += lanes) step(d, i);
  for (; i < words; ++i) step(Single(), i);
}

template <bool kCoefficient, bool kClear>
HWY_ATTR void level_of(const LevelClock& l) {
  const std::size_t n = l.row_words;
  const Word* const from = l.in;
  Word *const to = l.out, *const carries = l.carry;
  for (std::size_t row = 0; row < l.rows; ++row) {
    const Word* const in_row = from + row * n;
    Word *const left = to + 2 * row * n, *const right = left + n, *const kept = carries + row * n;
    over(n, [=](auto d, std::size_t i) HWY_ATTR {
      const auto in = hn::LoadU(d, in_row + i);
      const auto carry = kClear ? hn::Zero(d) : hn::LoadU(d, kept + i);
      const auto half = hn::Xor(in, carry);
      hn::StoreU(in, d, left + i);
      hn::StoreU(kCoefficient ? hn::Not(half) : half, d, right + i);
      hn::StoreU(kCoefficient ? hn::Or(in, carry) : hn::And(in, carry), d, kept + i);
    });
  }
}

HWY_ATTR void LevelStep(const LevelClock& l) {
  if (l.coefficient) {
    l.clear ? level_of<true, true>(l) : level_of<true, false>(l);
  } else {
    l.clear ? level_of<false, true>(l) : level_of<false, false>(l);
  }
}

/// Words that are worked on together: all their planes fit the host's nearest memory.
constexpr std::size_t kBlock = 256;

struct Operands {
  const Word *x, *y, *tree, *port_a, *enable, *carry, *data;
};

template <class F>
HWY_ATTR void map(Word* to, std::size_t n, const F& f) {
  over(n, [=](auto d, std::size_t i) HWY_ATTR { hn::StoreU(f(d, i), d, to + i); });
}
#define DENDRO_AT(plane) hn::LoadU(d, (plane) + i)
#define DENDRO_MAP(to, expression)                 \
  map(to, n, [=](auto d, std::size_t i) HWY_ATTR { \
    (void)i;                                       \
    return expression;                             \
  })

HWY_ATTR void source_of(Source source, const Operands& o, Word* to, std::size_t n) {
  switch (source) {
    case Source::kX:
      return DENDRO_MAP(to, DENDRO_AT(o.x));
    case Source::kXOrData:
      return DENDRO_MAP(to, hn::Or(DENDRO_AT(o.x), DENDRO_AT(o.data)));
    case Source::kXAndNotData:
      return DENDRO_MAP(to, hn::AndNot(DENDRO_AT(o.data), DENDRO_AT(o.x)));
    case Source::kSum:
      return DENDRO_MAP(to, hn::Xor(hn::Xor(DENDRO_AT(o.x), DENDRO_AT(o.y)), DENDRO_AT(o.carry)));
    case Source::kTree:
      return DENDRO_MAP(to, DENDRO_AT(o.tree));
    case Source::kCount:
      return;
  }
}

/// The borrow of x - y - c, and the carry of x + y + c, as the data sheet has them.
template <class D>
HWY_ATTR hn::Vec<D> borrow(D, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> c) {
  return hn::Or(hn::AndNot(x, y), hn::AndNot(hn::Xor(x, y), c));
}
template <class D>
HWY_ATTR hn::Vec<D> majority(D, hn::Vec<D> x, hn::Vec<D> y, hn::Vec<D> c) {
  return hn::Or(hn::And(x, y), hn::And(hn::Xor(x, y), c));
}

HWY_ATTR void function_of(Function function, const Operands& o, Word* enable, Word* carry, std::size_t n) {
  switch (function) {
    case Function::kSetEnable:
      return DENDRO_MAP(enable, hn::Not(hn::Zero(d)));
    case Function::kAndCarry:
      return DENDRO_MAP(enable, hn::And(DENDRO_AT(o.enable), DENDRO_AT(o.carry)));
    case Function::kAndNotCarry:
      return DENDRO_MAP(enable, hn::AndNot(DENDRO_AT(o.carry), DENDRO_AT(o.enable)));
    case Function::kLoad:
      return DENDRO_MAP(carry, DENDRO_AT(o.x));
    case Function::kBorrow:
      return DENDRO_MAP(carry, borrow(d, DENDRO_AT(o.x), DENDRO_AT(o.y), DENDRO_AT(o.carry)));
    case Function::kCarry:
      return DENDRO_MAP(carry, majority(d, DENDRO_AT(o.x), DENDRO_AT(o.y), DENDRO_AT(o.carry)));
    case Function::kEqual:
      return DENDRO_MAP(carry, hn::AndNot(hn::Xor(DENDRO_AT(o.x), DENDRO_AT(o.y)), DENDRO_AT(o.carry)));
    case Function::kHold:
    case Function::kCount:
      return;
  }
}

HWY_ATTR void data_of(DataOp op, const Operands& o, Word* data, std::size_t n) {
  switch (op) {
    case DataOp::kClear:
      return DENDRO_MAP(data, hn::Zero(d));
    case DataOp::kTree:
      return DENDRO_MAP(data, DENDRO_AT(o.tree));
    case DataOp::kOrTree:
      return DENDRO_MAP(data, hn::Or(DENDRO_AT(o.data), DENDRO_AT(o.tree)));
    case DataOp::kPortA:
      return DENDRO_MAP(data, DENDRO_AT(o.port_a));
    case DataOp::kHold:
    case DataOp::kCount:
      return;
  }
}

HWY_ATTR void write_where(const Word* source, const Word* enable, Word* to, std::size_t n) {
  DENDRO_MAP(to, hn::IfVecThenElse(DENDRO_AT(enable), DENDRO_AT(source), DENDRO_AT(to)));
}

bool changes_enable(Function function) {
  return function == Function::kSetEnable || function == Function::kAndCarry ||
         function == Function::kAndNotCarry;
}
/// Nothing that a word does changes these.
bool constant_in_a_clock(Operand x) {
  return x == Operand::kZero || x == Operand::kOne || x == Operand::kTree;
}

HWY_ATTR void block_of(const PixelClock& p, const ArrayWord& word, std::size_t first, std::size_t n) {
  alignas(64) static const Word zeros[kBlock] = {};
  alignas(64) Word ones[kBlock], worked_out[kBlock], enable_before[kBlock];
  if (word.x == Operand::kOne || word.y == Operand::kOne) std::fill(ones, ones + n, ~Word{0});
  const auto plane = [&](const Word* whole) { return whole ? whole + first : zeros; };
  const auto operand = [&](Operand which) -> const Word* {
    switch (which) {
      case Operand::kOne:
        return ones;
      case Operand::kTree:
        return plane(p.tree);
      case Operand::kPortA:
        return plane(p.read_a);
      case Operand::kPortB:
        return plane(p.read_b);
      case Operand::kData:
        return p.data + first;
      default:
        return zeros;
    }
  };
  const Operands o{operand(word.x),  operand(word.y), plane(p.tree), plane(p.read_a),
                   p.enable + first, p.carry + first, p.data + first};
  // Memory is written last, with source and E of before, so that all else still sees the memory of before.
  const bool writes = p.write_a || p.write_b;
  const Word *source = worked_out, *enable = o.enable;
  if (word.source == Source::kTree) {
    source = o.tree;
  } else if (word.source == Source::kX && constant_in_a_clock(word.x)) {
    source = o.x;
  } else if (writes) {
    source_of(word.source, o, worked_out, n);
  }
  if (writes && changes_enable(word.function)) enable = std::copy_n(o.enable, n, enable_before) - n;
  function_of(word.function, o, p.enable + first, p.carry + first, n);
  data_of(word.data, o, p.data + first, n);
  if (p.write_a) write_where(source, enable, p.write_a + first, n);
  if (p.write_b) write_where(source, enable, p.write_b + first, n);
}
#undef DENDRO_AT
#undef DENDRO_MAP

HWY_ATTR void PixelStep(const PixelClock& planes, const ArrayWord& word) {
  for (std::size_t first = 0; first < planes.words; first += kBlock)
    block_of(planes, word, first, std::min(kBlock, planes.words - first));
}

const char* TargetName() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace dendro::igc
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dendro::igc {

HWY_EXPORT(LevelStep);
HWY_EXPORT(PixelStep);
HWY_EXPORT(TargetName);

void clock_level(const LevelClock& level) { HWY_DYNAMIC_DISPATCH(LevelStep)(level); }
void clock_pixels(const PixelClock& planes, const ArrayWord& word) {
  HWY_DYNAMIC_DISPATCH(PixelStep)(planes, word);
}
const char* vector_target() { return HWY_DYNAMIC_DISPATCH(TargetName)(); }

}  // namespace dendro::igc
#endif
