#include "sort.h"

#include <stdbool.h>
#include <string.h>

/* A removed particle moves the records of the last one; more than this many out of order are sorted anew. */
#define FEW 32

typedef struct sorting {
    char *records;
    size_t count, size;
    int (*compare)(const void *a, const void *b);
} sorting;

static char *at(const sorting *s, size_t i) { return s->records + i * s->size; }

/* Room for one record, aligned for whatever it holds. */
typedef union room {
    char bytes[STF_SORT_BYTES_MAX];
    double number;
    void *pointer;
} room;

/* Restores the heap below `root`: no record is less than its children. */
static void sift_down(const sorting *s, size_t root, size_t count)
{
    room sifted;

    memcpy(&sifted, at(s, root), s->size);
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count && s->compare(at(s, child), at(s, child + 1)) < 0)
            child++;
        if (s->compare(&sifted, at(s, child)) >= 0)
            break;
        memcpy(at(s, root), at(s, child), s->size);
        root = child;
    }
    memcpy(at(s, root), &sifted, s->size);
}

/* Heapsort: J. W. J. Williams, Comm. ACM 7, 347 (1964). */
static void heapsort(const sorting *s)
{
    room largest;

    for (size_t root = s->count / 2; root-- > 0;)
        sift_down(s, root, s->count);
    for (size_t end = s->count; end-- > 1;) {
        memcpy(&largest, at(s, 0), s->size);
        memcpy(at(s, 0), at(s, end), s->size);
        memcpy(at(s, end), &largest, s->size);
        sift_down(s, 0, end);
    }
}

/*
 * Takes records out until the rest, which moves together, is in order; of two that are not, the one that fits worse. Returns
 * how many it took, FEW at most. If the rest is still not in order, *rest_sorted is false.
 */
static size_t take_out(const sorting *s, const sorting *taken, bool *rest_sorted)
{
    size_t kept = 0, taken_count = 0;

    *rest_sorted = true;
    for (size_t i = 0; i < s->count; i++) {
        const bool out_of_order = kept > 0 && s->compare(at(s, kept - 1), at(s, i)) > 0;

        if (!out_of_order || taken_count == FEW) {
            *rest_sorted = *rest_sorted && !out_of_order;
        } else if (kept > 1 && s->compare(at(s, kept - 2), at(s, i)) > 0) {
            memcpy(at(taken, taken_count++), at(s, i), s->size);
            continue;
        } else {
            memcpy(at(taken, taken_count++), at(s, --kept), s->size);
        }
        if (kept != i)
            memcpy(at(s, kept), at(s, i), s->size);
        kept++;
    }
    return taken_count;
}

/* Merges the sorted `taken` into the sorted records before them, from the end. */
static void put_back(const sorting *s, const sorting *taken)
{
    size_t taken_count = taken->count, rest = s->count - taken_count;

    for (size_t to = s->count; taken_count > 0; to--) {
        if (rest > 0 && s->compare(at(s, rest - 1), at(taken, taken_count - 1)) > 0)
            memcpy(at(s, to - 1), at(s, --rest), s->size);
        else
            memcpy(at(s, to - 1), at(taken, --taken_count), s->size);
    }
}

void stf_sort(void *records, size_t count, size_t size, int (*compare)(const void *a, const void *b))
{
    const sorting all = {.records = records, .count = count, .size = size, .compare = compare};
    room memory[FEW];
    sorting taken = {.records = memory[0].bytes, .size = size, .compare = compare};
    bool rest_sorted;

    taken.count = take_out(&all, &taken, &rest_sorted);
    if (rest_sorted) {
        heapsort(&taken);
        put_back(&all, &taken);
    } else {
        memcpy(at(&all, count - taken.count), memory, taken.count * size);
        heapsort(&all);
    }
}
