#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "models/machines/pixel_planes/tile_kernels.cpp"
#include <hwy/foreach_target.h>
// What follows is compiled once per instruction set.
#include <hwy/highway.h>
#include "models/machines/pixel_planes/tile_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace dendro::pixel_planes::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<std::int32_t, kTileSide>;
using V = hn::Vec<D>;

/// T of every pixel of a tile, limited to -1 .. most + 1, and its low bits as stored.
struct Depths {
  alignas(64) std::int32_t z[kTilePixels];
  alignas(64) std::int32_t low[kTilePixels];
};

void wide_depths(const TileOp& op, Depths& out) {
  const int up = 64 - op.stream_bits;
  for (int y = 0; y < kTileSide; ++y)
    for (int x = 0; x < kTileSide; ++x) {
      const std::uint64_t sum = static_cast<std::uint64_t>(op.a) * static_cast<unsigned>(x) +
                                static_cast<std::uint64_t>(op.b) * static_cast<unsigned>(y) +
                                static_cast<std::uint64_t>(op.c);
      const std::int64_t whole = (static_cast<std::int64_t>(sum << up) >> up) >> op.fraction;
      const std::int64_t limited = whole < -1 ? -1 : whole > op.most + 1 ? op.most + 1 : whole;
      out.z[y * kTileSide + x] = static_cast<std::int32_t>(limited);
      out.low[y * kTileSide + x] = static_cast<std::int32_t>(whole & op.most);
    }
}

/// Calls `change(position, z, low)` for every vector of the tile.
template <class Change>
HWY_ATTR HWY_INLINE void each(const TileOp& op, Depths& depths, const Change& change) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  if (op.stream_bits == 0) {
    for (std::size_t at = 0; at < kTilePixels; at += lanes) change(at, hn::Zero(d), hn::Zero(d));
  } else if (op.narrow) {
    const V before = hn::Set(d, -1), beyond = hn::Set(d, op.most + 1), mask = hn::Set(d, op.most);
    const V step = hn::Set(d, static_cast<std::int32_t>(op.b));
    for (std::size_t x = 0; x < kTileSide; x += lanes) {
      V t = hn::Add(hn::Set(d, static_cast<std::int32_t>(op.c)),
                    hn::Mul(hn::Set(d, static_cast<std::int32_t>(op.a)), hn::Iota(d, static_cast<std::int32_t>(x))));
      for (std::size_t at = x; at < kTilePixels; at += kTileSide) {
        const V whole = hn::ShiftRightSame(t, op.fraction);
        change(at, hn::Min(hn::Max(whole, before), beyond), hn::And(whole, mask));
        t = hn::Add(t, step);
      }
    }
  } else {
    wide_depths(op, depths);
    for (std::size_t at = 0; at < kTilePixels; at += lanes)
      change(at, hn::Load(d, depths.z + at), hn::Load(d, depths.low + at));
  }
}

HWY_ATTR HWY_INLINE V load(const std::uint32_t* field, std::size_t at) {
  return hn::Load(D(), reinterpret_cast<const std::int32_t*>(field) + at);
}
HWY_ATTR HWY_INLINE void store(V value, std::uint32_t* field, std::size_t at) {
  hn::Store(value, D(), reinterpret_cast<std::int32_t*>(field) + at);
}
HWY_ATTR HWY_INLINE void store_where(hn::Mask<D> where, std::uint32_t value, std::uint32_t* field, std::size_t at) {
  store(hn::IfThenElse(where, hn::Set(D(), static_cast<std::int32_t>(value)), load(field, at)), field, at);
}
HWY_ATTR HWY_INLINE hn::Mask<D> flagged(const std::uint32_t* field, std::size_t at) {
  return hn::TestBit(load(field, at), hn::Set(D(), 1));
}

HWY_ATTR void run_op(const TileOp& op, Depths& t) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1), most = hn::Set(d, op.most);
  std::uint32_t *const f0 = op.field[0], *const f1 = op.field[1], *const f2 = op.field[2];
  switch (op.kind) {
    case MacroKind::kFill:
      each(op, t, [&](std::size_t at, V, V) HWY_ATTR { store(hn::Set(d, static_cast<std::int32_t>(op.constant)), f0, at); });
      break;
    case MacroKind::kRaiseScratch:
      each(op, t, [&](std::size_t at, V, V low) HWY_ATTR { store(low, f1, at); });
      [[fallthrough]];
    case MacroKind::kRaise:
      each(op, t, [&](std::size_t at, V z, V) HWY_ATTR { store(hn::Max(load(f0, at), hn::Min(z, most)), f0, at); });
      break;
    case MacroKind::kLowerScratch:
      each(op, t, [&](std::size_t at, V, V low) HWY_ATTR { store(low, f1, at); });
      [[fallthrough]];
    case MacroKind::kLower:
      each(op, t, [&](std::size_t at, V z, V) HWY_ATTR { store(hn::Min(load(f0, at), hn::Max(z, zero)), f0, at); });
      break;
    case MacroKind::kKill:
      each(op, t, [&](std::size_t at, V z, V) HWY_ATTR { store(hn::IfThenZeroElse(hn::Lt(z, zero), load(f0, at)), f0, at); });
      break;
    case MacroKind::kCloseOpen:
      each(op, t, [&](std::size_t at, V, V) HWY_ATTR {
        const V back = load(f0, at);
        store(hn::IfThenZeroElse(hn::Eq(back, most), back), f0, at);
      });
      break;
    case MacroKind::kFinish:
      each(op, t, [&](std::size_t at, V, V) HWY_ATTR {
        const V front = load(f0, at), back = load(f1, at), nearest = load(f2, at);
        const auto seen = hn::And(hn::Lt(front, back), hn::Lt(front, nearest));
        store(hn::IfThenElse(seen, front, nearest), f2, at);
        store(hn::Or(hn::AndNot(one, back), hn::IfThenElseZero(seen, one)), f1, at);
      });
      break;
    case MacroKind::kMatchPaint:
      each(op, t, [&](std::size_t at, V z, V) HWY_ATTR {
        store_where(hn::And(flagged(f1, at), hn::Eq(z, load(f0, at))), op.constant, f2, at);
      });
      break;
    case MacroKind::kPaint:
      each(op, t, [&](std::size_t at, V, V) HWY_ATTR { store_where(flagged(f1, at), op.constant, f2, at); });
      break;
    case MacroKind::kRaiseIndex:
      each(op, t, [&](std::size_t at, V z, V) HWY_ATTR {
        const V front = load(f0, at);
        store_where(hn::Gt(z, front), op.constant, f1, at);
        store(hn::Max(front, hn::Min(z, most)), f0, at);
      });
      break;
    case MacroKind::kPaintIndex:
      each(op, t, [&](std::size_t at, V, V) HWY_ATTR {
        const V match = hn::Set(d, static_cast<std::int32_t>(op.match));
        store_where(hn::And(flagged(f1, at), hn::Eq(match, load(f0, at))), op.constant, f2, at);
      });
      break;
    case MacroKind::kSignFirst:
    case MacroKind::kSign:
      break;  // flags are kept as bits
  }
}

HWY_ATTR void RunTile(const TileOp* ops, std::size_t count) {
  Depths depths{};
  for (std::size_t n = 0; n < count; ++n) run_op(ops[n], depths);
}

}  // namespace dendro::pixel_planes::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace dendro::pixel_planes {
HWY_EXPORT(RunTile);
void run_tile(const TileOp* ops, std::size_t count) { HWY_DYNAMIC_DISPATCH(RunTile)(ops, count); }
}  // namespace dendro::pixel_planes
#endif
