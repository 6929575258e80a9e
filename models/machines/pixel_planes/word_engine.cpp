#include "models/machines/pixel_planes/word_engine.h"

#include <algorithm>
#include <array>

#include "models/machines/pixel_planes/bit_array.h"
#include "sim/base/check.h"

namespace dendro::pixel_planes {
namespace {

constexpr std::size_t kMostFields = 32;    ///< bits of Batch::overwritten
constexpr std::size_t kMostBatches = 4096; ///< kept for tiles that wait

std::int64_t all_ones(unsigned bits) { return (std::int64_t{1} << bits) - 1; }

bool overlap(const FieldPlace& p, const FieldPlace& q) {
  return p.low < q.low + q.bits && q.low < p.low + p.bits;
}

bool is_flag(MacroKind kind, unsigned field) {
  return field == 1 && (kind == MacroKind::kMatchPaint || kind == MacroKind::kPaint || kind == MacroKind::kPaintIndex);
}

}  // namespace

WordEngine::WordEngine(const Spec& spec, bool lazy)
    : spec_(spec),
      lazy_(lazy),
      tiles_x_(spec.array.width / kTileSide),
      tiles_y_(spec.array.height / kTileSide),
      bits_(spec),
      flags_(spec),
      waiting_(static_cast<std::size_t>(tiles_x_ * tiles_y_), -1) {
  batches_.emplace_back();
}

void WordEngine::execute(const MacroProgram& program, const igc::Command& command,
                         const igc::ControllerState& controller) {
  const auto macros = program.macros(command, controller);
  bool known = macros.has_value();
  if (known)
    for (const Macro& macro : *macros)
      for (unsigned k = 0; k < macro.field_count; ++k)
        known = known && macro.fields[k].low + macro.fields[k].bits <= bits_.memory.size();
  if (known && is_sign(macros->front().kind)) {
    known = false;
    if (lazy_) {
      to_bits();
      fields_.clear();
      counters_.pixel_operations += static_cast<std::uint64_t>(spec_.pixels());
      if (flags_.apply(macros->front())) return;
      counters_.pixel_operations -= static_cast<std::uint64_t>(spec_.pixels());
    }
  }
  if (!known) {
    execute_bits(program, command, controller);
    return;
  }
  flags_.forget_all(bits_);
  if (macros->front().kind == MacroKind::kFill) flush();  // fills begin a batch
  for (const Macro& macro : *macros) {
    DENDRO_CHECK(add(macro), "field {}", macro.fields[0].low);
    counters_.pixel_operations += static_cast<std::uint64_t>(spec_.pixels());
  }
}

void WordEngine::execute_bits(const MacroProgram& program, const igc::Command& command,
                              const igc::ControllerState& controller) {
  to_bits();
  fields_.clear();
  flags_.settle(bits_);
  const auto words = igc::expand(program.words(), command, controller, static_cast<unsigned>(spec_.tree.gap_clocks));
  const std::vector<std::uint32_t>* only = nullptr;
  unsigned flag = igc::kMostMemoryBits;
  if (lazy_ && program.gate()) {
    flag = words[1].address_a;
    only = flags_.live(flag, bits_);
  }
  apply_words(spec_, command, words, bits_, only);
  for (const igc::ArrayWord& word : words) {
    if (word.write_a && (only == nullptr || word.address_a != flag)) flags_.forget(word.address_a);
    if (word.write_b && (only == nullptr || word.address_b != flag)) flags_.forget(word.address_b);
  }
  const auto pixels = static_cast<std::uint64_t>(spec_.pixels());
  counters_.pixel_operations += pixels;
  counters_.evaluated += only ? only->size() * 64 : pixels;
  ++counters_.bitwise_commands;
}

/// The field's number. A field in a new place is taken from the bits; one that it cuts is given up.
int WordEngine::field_of(const FieldPlace& place, bool flag) {
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const FieldPlace& known = fields_[k].place;
    if (known == place || (flag && known.low == place.low)) return static_cast<int>(k);
  }
  const bool cuts = std::any_of(fields_.begin(), fields_.end(), [&](const Field& f) { return overlap(f.place, place); });
  if (cuts || fields_.size() >= kMostFields) {
    to_bits();
    fields_.clear();
  }
  fields_.push_back({place, std::vector<TileField>(waiting_.size())});
  load(fields_.back());
  return static_cast<int>(fields_.size()) - 1;
}

bool WordEngine::add(const Macro& macro) {
  Op op;
  op.macro = macro;
  const bool fill = macro.kind == MacroKind::kFill;
  for (bool again = true; again;) {
    again = false;
    for (unsigned k = 0; k < macro.field_count; ++k) {
      if (macro.fields[k].bits == 0) continue;
      const std::size_t before = fields_.size();
      op.field[k] = field_of(macro.fields[k], is_flag(macro.kind, k));
      again = again || fields_.size() < before;  // all were given up: their numbers are others now
    }
  }
  Batch& batch = batches_.back();
  const bool copies = macro.kind == MacroKind::kRaiseScratch || macro.kind == MacroKind::kLowerScratch;
  const int whole = fill ? op.field[0] : copies ? op.field[1] : -1;
  if (whole >= 0) {
    const auto uses = [&](const Op& earlier) {
      return std::find(std::begin(earlier.field), std::end(earlier.field), whole) != std::end(earlier.field);
    };
    if (std::none_of(batch.ops.begin(), batch.ops.end(), uses)) batch.overwritten |= 1u << whole;
  }
  batch.ops.push_back(op);
  bits_current_ = false;
  return op.field[0] >= 0 || op.field[1] >= 0;
}

/// Applies the open batch, or leaves it to the tiles that cannot show it.
void WordEngine::flush() {
  if (batches_.back().ops.empty()) return;
  const int number = static_cast<int>(batches_.size()) - 1;
  flush_square({0, 0, tiles_x_, tiles_y_}, number);
  batches_.emplace_back();
  if (batches_.size() > kMostBatches) catch_up_all();
}

void WordEngine::flush_square(const Square& square, int batch) {
  const Batch& now = batches_[static_cast<std::size_t>(batch)];
  if (lazy_ && now.overwritten != 0 && touches_scratch_only(now, square)) {
    for (int y = square.tile_y; y < square.tile_y + square.tiles_y; ++y)
      for (int x = square.tile_x; x < square.tile_x + square.tiles_x; ++x) {
        const int tile = y * tiles_x_ + x;
        int& waits = waiting_[static_cast<std::size_t>(tile)];
        if (waits >= 0 && (batches_[static_cast<std::size_t>(waits)].overwritten & ~now.overwritten) != 0) catch_up(tile);
        waits = batch;
      }
    return;
  }
  if (square.tiles_x == 1 && square.tiles_y == 1) {
    const int tile = square.tile_y * tiles_x_ + square.tile_x;
    int& waits = waiting_[static_cast<std::size_t>(tile)];
    if (waits >= 0 && (batches_[static_cast<std::size_t>(waits)].overwritten & ~now.overwritten) != 0) catch_up(tile);
    waits = -1;
    run(now, tile);
    return;
  }
  const int half_x = std::max(1, square.tiles_x / 2), half_y = std::max(1, square.tiles_y / 2);
  for (int y = 0; y < square.tiles_y; y += half_y)
    for (int x = 0; x < square.tiles_x; x += half_x)
      flush_square({square.tile_x + x, square.tile_y + y, half_x, half_y}, batch);
}

/// Exact bounds of A·x + B·y + C over the pixels.
WordEngine::Interval WordEngine::sum_of(const Macro& macro, const Square& square) const {
  const std::int64_t x0 = square.tile_x * kTileSide, x1 = x0 + square.tiles_x * kTileSide - 1;
  const std::int64_t y0 = square.tile_y * kTileSide, y1 = y0 + square.tiles_y * kTileSide - 1;
  const std::int64_t ax0 = macro.a * x0, ax1 = macro.a * x1, by0 = macro.b * y0, by1 = macro.b * y1;
  return {macro.c + std::min(ax0, ax1) + std::min(by0, by1), macro.c + std::max(ax0, ax1) + std::max(by0, by1)};
}

/// Bounds of T; all values when the stream is too short for some pixel.
WordEngine::Interval WordEngine::depth_of(const Macro& macro, const Square& square) const {
  Interval sum = sum_of(macro, square);
  const std::int64_t most = all_ones(macro.stream_bits - 1);
  if (sum.low < -most - 1 || sum.high > most) sum = {-most - 1, most};
  return {sum.low >> macro.fraction, sum.high >> macro.fraction};
}

/// True when the batch changes nothing but the fields that it overwrites first: bounds of every field are followed
/// through its operations.
bool WordEngine::touches_scratch_only(const Batch& batch, const Square& square) const {
  std::array<Interval, kMostFields> bounds;
  for (std::size_t k = 0; k < fields_.size(); ++k) bounds[k] = {0, all_ones(fields_[k].place.bits)};
  std::uint32_t unflagged = 0;  // fields whose bit 0 is 0 everywhere
  for (const Op& op : batch.ops) {
    const Macro& macro = op.macro;
    const auto scratch = [&](int field) { return field < 0 || (batch.overwritten >> field & 1) != 0; };
    Interval* const f0 = op.field[0] >= 0 ? &bounds[static_cast<std::size_t>(op.field[0])] : nullptr;
    switch (macro.kind) {
      case MacroKind::kFill:
        if (!scratch(op.field[0])) return false;
        f0->low = f0->high = static_cast<std::int64_t>(macro.constant);
        break;
      case MacroKind::kRaise:
      case MacroKind::kRaiseScratch:
      case MacroKind::kRaiseIndex:
      case MacroKind::kLower:
      case MacroKind::kLowerScratch: {
        if (!scratch(op.field[0]) || !scratch(op.field[1])) return false;
        const std::int64_t most = all_ones(macro.fields[0].bits);
        const Interval t = depth_of(macro, square);
        const std::int64_t low = std::clamp<std::int64_t>(t.low, 0, most), high = std::clamp<std::int64_t>(t.high, 0, most);
        const bool raise = macro.kind != MacroKind::kLower && macro.kind != MacroKind::kLowerScratch;
        *f0 = raise ? Interval{std::max(f0->low, low), std::max(f0->high, high)}
                    : Interval{std::min(f0->low, low), std::min(f0->high, high)};
        if (op.field[1] >= 0) bounds[static_cast<std::size_t>(op.field[1])] = {0, all_ones(macro.fields[1].bits)};
        break;
      }
      case MacroKind::kKill: {
        if (!scratch(op.field[0])) return false;
        const Interval t = depth_of(macro, square);
        if (t.low < 0) f0->low = 0;
        if (t.high < 0) f0->high = 0;
        break;
      }
      case MacroKind::kCloseOpen:
        if (!scratch(op.field[0])) return false;
        if (f0->high == all_ones(macro.fields[0].bits)) {
          const bool always = f0->low == f0->high;
          *f0 = {0, always ? 0 : f0->high - 1};
        }
        break;
      case MacroKind::kFinish: {
        if (!scratch(op.field[1])) return false;
        Interval& back = bounds[static_cast<std::size_t>(op.field[1])];
        if (f0->low < back.high) return false;  // it may be seen
        back = {back.low & ~std::int64_t{1}, back.high};
        unflagged |= 1u << op.field[1];
        continue;
      }
      case MacroKind::kMatchPaint:
      case MacroKind::kPaint:
      case MacroKind::kPaintIndex:
        if ((unflagged >> op.field[1] & 1) == 0) return false;
        continue;
      case MacroKind::kSignFirst:
      case MacroKind::kSign:
        return false;  // flags are kept as bits
    }
    if (op.field[0] >= 0) unflagged &= ~(1u << op.field[0]);
    if (op.field[1] >= 0) unflagged &= ~(1u << op.field[1]);
  }
  return true;
}

void WordEngine::run(const Batch& batch, int tile) {
  const Square square{tile % tiles_x_, tile / tiles_x_, 1, 1};
  tile_ops_.clear();
  for (const Op& op : batch.ops) {
    const Macro& macro = op.macro;
    TileOp out{};
    out.kind = macro.kind;
    for (int k = 0; k < 3; ++k)
      if (op.field[k] >= 0)
        out.field[k] = fields_[static_cast<std::size_t>(op.field[k])].tiles[static_cast<std::size_t>(tile)].values;
    out.most = static_cast<std::int32_t>(all_ones(std::max(1u, macro.fields[0].bits)));
    out.constant = static_cast<std::uint32_t>(macro.constant);
    if (macro.kind == MacroKind::kPaintIndex) {
      out.match = static_cast<std::uint32_t>(macro.constant & 0xFFF);
      out.constant = static_cast<std::uint32_t>(macro.constant >> 12 & 0xFFFFFF);
    } else if (macro.kind == MacroKind::kRaiseIndex) {
      out.constant &= 0xFFF;
    } else if (macro.kind != MacroKind::kFill) {
      out.constant &= 0xFFFFFF;
    }
    if (macro.stream_bits > 0) {
      const Interval sum = sum_of(macro, square);
      const std::int64_t stream = all_ones(macro.stream_bits - 1);
      const std::int64_t most = std::min<std::int64_t>(stream, INT32_MAX);
      out.narrow = sum.low >= -most - 1 && sum.high <= most && macro.fraction < 32;
      out.a = macro.a, out.b = macro.b;
      out.c = macro.c + macro.a * square.tile_x * kTileSide + macro.b * square.tile_y * kTileSide;
      out.fraction = static_cast<int>(macro.fraction), out.stream_bits = static_cast<int>(macro.stream_bits);
    }
    tile_ops_.push_back(out);
  }
  run_tile(tile_ops_.data(), tile_ops_.size());
  counters_.evaluated += tile_ops_.size() * kTilePixels;
}

void WordEngine::catch_up(int tile) {
  int& waits = waiting_[static_cast<std::size_t>(tile)];
  if (waits < 0) return;
  const int batch = waits;
  waits = -1;
  run(batches_[static_cast<std::size_t>(batch)], tile);
}

void WordEngine::catch_up_all() {
  flush();
  for (int tile = 0; tile < tiles_x_ * tiles_y_; ++tile) catch_up(tile);
  batches_.clear();
  batches_.emplace_back();
}

std::size_t WordEngine::tile_of(int pixel, std::size_t& inside) const {
  const int x = pixel % spec_.array.width, y = pixel / spec_.array.width;
  inside = static_cast<std::size_t>(y % kTileSide * kTileSide + x % kTileSide);
  return static_cast<std::size_t>(y / kTileSide * tiles_x_ + x / kTileSide);
}

std::uint32_t WordEngine::peek(int pixel, unsigned low) {
  flush();
  flags_.settle(bits_);
  std::size_t inside = 0;
  const std::size_t tile = tile_of(pixel, inside);
  const Batch* waits = waiting_[tile] >= 0 ? &batches_[static_cast<std::size_t>(waiting_[tile])] : nullptr;
  std::uint64_t word = 0, known = 0;
  for (std::size_t k = 0; k < fields_.size(); ++k) {
    const FieldPlace& place = fields_[k].place;
    if (!overlap(place, {low, 32})) continue;
    if (waits && (waits->overwritten >> k & 1) != 0) {
      catch_up(static_cast<int>(tile));
      waits = nullptr;
    }
    const std::uint64_t mask = static_cast<std::uint64_t>(all_ones(place.bits));
    const std::uint64_t value = fields_[k].tiles[tile].values[inside];
    const bool up = place.low >= low;
    known |= up ? mask << (place.low - low) : mask >> (low - place.low);
    word |= up ? value << (place.low - low) : value >> (low - place.low);
  }
  for (unsigned bit = low; bit < std::min<std::size_t>(low + 32, bits_.memory.size()); ++bit)
    if ((known >> (bit - low) & 1) == 0)
      word |= (bits_.memory[bit][static_cast<std::size_t>(pixel) / 64] >> (pixel % 64) & 1) << (bit - low);
  return static_cast<std::uint32_t>(word);
}

const ArrayState& WordEngine::bits() {
  to_bits();
  flags_.settle(bits_);
  return bits_;
}

void WordEngine::to_bits() {
  if (bits_current_) return;
  catch_up_all();
  for (const Field& field : fields_) save(field);
  bits_current_ = true;
}

/// Of a new field, which holds zeros.
void WordEngine::load(Field& field) const {
  for (unsigned b = 0; b < field.place.bits; ++b) {
    const Plane& plane = bits_.memory[field.place.low + b];
    for (std::size_t word = 0; word < plane.size(); ++word) {
      if (plane[word] == 0) continue;
      std::size_t inside = 0;
      const std::size_t first = tile_of(static_cast<int>(word) * 64, inside);
      for (std::size_t p = 0; p < 64; ++p)
        field.tiles[first + p / kTileSide].values[inside + p % kTileSide] |= static_cast<std::uint32_t>(plane[word] >> p & 1) << b;
    }
  }
}

void WordEngine::save(const Field& field) {
  for (unsigned b = 0; b < field.place.bits; ++b) {
    Plane& plane = bits_.memory[field.place.low + b];
    for (std::size_t word = 0; word < plane.size(); ++word) {
      std::uint64_t value = 0;
      std::size_t inside = 0;
      const std::size_t first = tile_of(static_cast<int>(word) * 64, inside);
      for (std::size_t p = 0; p < 64; ++p) {
        const TileField& tile = field.tiles[first + p / kTileSide];
        value |= static_cast<std::uint64_t>(tile.values[inside + p % kTileSide] >> b & 1) << p;
      }
      plane[word] = value;
    }
  }
}

}  // namespace dendro::pixel_planes
