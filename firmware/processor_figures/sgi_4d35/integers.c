#include "firmware/lib/mips/dendro.h"
#include "firmware/processor_figures/sgi_4d35/figures.h"

/* ASSUMED DEV-171: what programs of the time did with integers: records and pointers, names that are copied and compared, calls, tables, a
 * division now and then. All of it stays in both caches. */

enum kind { kOak, kPine, kBirch, kKinds };

struct record {
  struct record* next;
  enum kind kind;
  int year, height;
  char name[kFigNameBytes];
};

static struct record records[kFigRecords];
static int yearly[kKinds][16];
static const char* const kNames[kKinds] = {"AN OAK IN THE PARK, NUMBER ", "A PINE ON THE HILL, NUMBER ", "A BIRCH BY THE ROAD, NUMBER"};

__attribute__((noinline)) static void copy_name(char* to, const char* from) {
  while ((*to++ = *from++) != 0) {
  }
}

__attribute__((noinline)) static int compare_names(const char* a, const char* b) {
  while (*a != 0 && *a == *b) ++a, ++b;
  return *a - *b;
}

__attribute__((noinline)) static enum kind kind_after(enum kind kind) {
  switch (kind) {
    case kOak: return kPine;
    case kPine: return kBirch;
    default: return kOak;
  }
}

__attribute__((noinline)) static void name_record(struct record* r, int number) {
  copy_name(r->name, kNames[r->kind]);
  char* end = r->name;
  while (*end != 0) ++end;
  end[0] = (char)('0' + number / 10);
  end[1] = (char)('0' + number % 10);
  end[2] = 0;
}

__attribute__((noinline)) static void insert(struct record** head, struct record* r) {
  struct record** at = head;
  while (*at != 0 && compare_names((*at)->name, r->name) < 0) at = &(*at)->next;
  r->next = *at;
  *at = r;
}

__attribute__((noinline)) static void grow(struct record* r, int round) {
  const int year = (r->year + round) & 15;
  if (r->kind == kPine && year > 7)
    r->height += 3;
  else
    r->height += year >> 2;
  yearly[r->kind][year] += r->height - r->year;
  r->year = year;
}

__attribute__((noinline)) static uint32_t sum_of(const struct record* r) {
  uint32_t sum = 0;
  for (; r != 0; r = r->next) {
    sum = (sum << 5 | sum >> 27) ^ (uint32_t)(r->height + r->year);
    sum += (uint32_t)r->name[0] + (uint32_t)r->kind;
  }
  return sum;
}

int main(void) {
  uint32_t sum = 0;
  dendro_mark(kMarkLabel, kFigInteger);
  for (int round = 0; round < kFigRounds; ++round) {
    struct record* head = 0;
    enum kind kind = kOak;
    for (int i = 0; i < kFigRecords; ++i) {
      struct record* r = &records[i * 7 % kFigRecords];
      r->kind = kind;
      kind = kind_after(kind);
      name_record(r, i * 7 % kFigRecords);
      grow(r, round);
      insert(&head, r);
    }
    sum ^= sum_of(head);
  }
  dendro_mark(kMarkLabel, kFigCheck);
  for (int k = 0; k < kKinds; ++k)
    for (int year = 0; year < 16; ++year) sum += (uint32_t)yearly[k][year] * (uint32_t)(year + 1);
  printf("%d rounds of %d records: %08x\n", kFigRounds, kFigRecords, sum);
  return 0;
}
