#include "firmware/lib/mips/dendro.h"

static uint32_t state = 1;
static uint32_t draw(void) {
  state = state * 1664525u + 1013904223u;
  return state >> 8;
}

struct item {
  unsigned char* bytes;
  unsigned size, mark;
};

static int whole(const struct item* item) {
  for (unsigned i = 0; i < item->size; ++i)
    if (item->bytes[i] != (unsigned char)(item->mark + i)) return 0;
  return 1;
}

static unsigned deep(unsigned depth) { /* a page of stack each */
  volatile unsigned char page[4096];
  page[depth & 4095] = (unsigned char)depth;
  return (depth ? deep(depth - 1) : 0) + page[depth & 4095];
}

/* The allocator under random use, more pages than the TLB holds, moves that overlap, a file written and read
 * again. */
int main(int argc, char** argv) {
  static struct item items[100];
  unsigned bad = 0;
  for (int i = 0; i < 4000; ++i) {
    struct item* item = &items[draw() % 100];
    if (item->bytes) {
      bad += !whole(item);
      free(item->bytes);
      item->bytes = NULL;
    } else {
      item->size = draw() % 3000;
      item->mark = draw();
      item->bytes = malloc(item->size);
      for (unsigned k = 0; k < item->size; ++k) item->bytes[k] = (unsigned char)(item->mark + k);
    }
  }
  printf("damaged blocks %u\n", bad);
  unsigned* pages = calloc(1024, 1024);
  unsigned sum = 0;
  for (unsigned i = 0; i < 262144; i += 64) pages[i] = i;
  for (unsigned turn = 0; turn < 4; ++turn)
    for (unsigned i = turn; i < 262144; i += 1024 + 64) sum = sum * 31 + pages[i];
  printf("pages %x\n", sum);
  printf("stack %u\n", deep(500));
  printf("too much %d\n", malloc(0x7FFFFFFFu) == NULL);
  char text[40] = "0123456789abcdefghijklmnopqrstuvwxyz";
  memmove(text + 3, text, 20);
  memmove(text + 1, text + 5, 10);
  printf("%s %d %d\n", text, memcmp("abd", "abc", 3), strcmp("ab", "abc") < 0);
  if (argc > 1) {
    const long out = dendro_call(kSysOpen, (long)argv[1], 0x301, 0644);
    const long wrote = dendro_call(kSysWrite, out, (long)pages, 300000);
    printf("wrote %ld, closed %ld\n", wrote, dendro_call(kSysClose, out, 0, 0));
    const long in = dendro_call(kSysOpen, (long)argv[1], 0, 0);
    unsigned char* again = malloc(300000);
    long got = 0, now;
    while ((now = dendro_call(kSysRead, in, (long)again + got, 300000 - got)) > 0) got += now;
    printf("read %ld, same %d, at %ld\n", got, memcmp(again, pages, 300000) == 0,
           dendro_call(kSysLseek, in, 5, 0));
  }
  printf("no file %ld, bad file %ld, bad address %ld\n", dendro_call(kSysOpen, (long)"/no/such/file", 0, 0),
         dendro_call(kSysClose, 77, 0, 0), dendro_call(kSysWrite, 1, 0x1000, 5));
  return 0;
}
