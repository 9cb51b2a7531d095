#include "spring_order.h"

#include "forces/spring.h"
#include "sort.h"

static uint32_t lower(const stf_spring *s) { return s->a < s->b ? s->a : s->b; }
static uint32_t upper(const stf_spring *s) { return s->a < s->b ? s->b : s->a; }

static int compare_numbers(uint32_t a, uint32_t b) { return (a > b) - (a < b); }

/* By the block of the lower end, by the difference of the ends, by the lower end; and in the end by all fields, so that springs
   of the same ends have one order too. */
static int compare_springs(const void *left, const void *right)
{
    const stf_spring *a = left, *b = right;
    int order = compare_numbers(lower(a) / STF_BLOCK_MAX, lower(b) / STF_BLOCK_MAX);

    if (order == 0)
        order = compare_numbers(upper(a) - lower(a), upper(b) - lower(b));
    if (order == 0)
        order = compare_numbers(lower(a), lower(b));
    if (order == 0)
        order = stf_compare_reals(a->stiffness, b->stiffness);
    if (order == 0)
        order = stf_compare_reals(a->damping, b->damping);
    if (order == 0)
        order = stf_compare_reals(a->rest_length, b->rest_length);
    if (order == 0)
        order = compare_numbers(a->a, b->a);
    return order;
}

/* Behind any run may be one stretch of loose springs. */
static size_t stretches_max(size_t spring_count) { return 2 * (spring_count / STF_RUN_MIN) + 1; }

size_t stf_springs_arranged_size(size_t spring_count)
{
    const size_t each = sizeof(stf_stretch) + 3 * sizeof(stf_real) + sizeof(stf_spring);

    if (spring_count > SIZE_MAX / 2 / each)
        return SIZE_MAX;
    return sizeof(stf_spring_order) + stretches_max(spring_count) * sizeof(stf_stretch) +
           spring_count * (3 * sizeof(stf_real) + sizeof(stf_spring));
}

static bool same_block(uint32_t a, uint32_t b) { return a / STF_BLOCK_MAX == b / STF_BLOCK_MAX; }

/* How many springs from here on are a run. */
static size_t run_length(const stf_spring *springs, size_t count)
{
    const uint32_t first_lower = lower(springs), first_upper = upper(springs);
    size_t n = 1;

    while (n < count && lower(&springs[n]) == first_lower + n && upper(&springs[n]) == first_upper + n &&
           same_block(lower(&springs[n]), first_lower) && same_block(upper(&springs[n]), first_upper))
        n++;
    return n;
}

static void add_run(stf_spring_order *to, const stf_spring *springs, size_t first, size_t count)
{
    to->stretches[to->stretch_count++] = (stf_stretch){.first = first, .count = count, .is_run = true,
                                                       .lower = lower(&springs[first]), .upper = upper(&springs[first])};
}

static void add_loose(stf_spring_order *to, size_t first, size_t count)
{
    stf_stretch *last = to->stretch_count > 0 ? &to->stretches[to->stretch_count - 1] : NULL;

    if (count > 0 && last && !last->is_run)
        last->count += count;
    else if (count > 0)
        to->stretches[to->stretch_count++] = (stf_stretch){.first = first, .count = count};
}

/*
 * Loose springs stand by groups of blocks of their lower end, in a group by the block of the upper end: the lower ends' blocks
 * stay in the second-level cache (9 KiB each, with forces), and each upper block comes by once a group. Measured in a random
 * net of 4e5 springs in double: 17 ns a spring, 23 in the order of the lower ends alone, 20 with groups of 8 blocks.
 */
#define GROUP_BLOCKS 32

static bool same_group(uint32_t a, uint32_t b)
{
    return a / (GROUP_BLOCKS * STF_BLOCK_MAX) == b / (GROUP_BLOCKS * STF_BLOCK_MAX);
}

static int compare_loose(const void *left, const void *right)
{
    const stf_spring *a = left, *b = right;
    const int order = compare_numbers(upper(a) / STF_BLOCK_MAX, upper(b) / STF_BLOCK_MAX);

    return order ? order : compare_springs(left, right);
}

static void find_stretches(const stf_spring *springs, size_t spring_count, stf_spring_order *found)
{
    size_t added = 0; /* loose springs that are in a stretch */

    found->stretch_count = found->loose_count = 0;
    for (size_t first = 0, n; first < spring_count; first += n) {
        n = run_length(springs + first, spring_count - first);
        if (n >= STF_RUN_MIN)
            add_run(found, springs, first, n);
        for (size_t i = first; n < STF_RUN_MIN && i < first + n; i++)
            found->loose[found->loose_count++] = springs[i];
        if (first + n == spring_count || !same_group(lower(&springs[first + n]), lower(&springs[first]))) {
            stf_sort(found->loose + added, found->loose_count - added, sizeof *springs, compare_loose);
            add_loose(found, added, found->loose_count - added);
            added = found->loose_count;
        }
    }
}

void stf_springs_arrange(void *records, size_t record_count)
{
    const stf_spring *springs = records;
    stf_spring_order *arranged = stf_force_arranged(records, record_count, sizeof *springs);

    stf_sort(records, record_count, sizeof *springs, compare_springs);
    arranged->stretches = (stf_stretch *)(arranged + 1);
    arranged->stiffness = (stf_real *)(arranged->stretches + stretches_max(record_count));
    arranged->damping = arranged->stiffness + record_count;
    arranged->rest_length = arranged->damping + record_count;
    arranged->loose = (stf_spring *)(arranged->rest_length + record_count);
    find_stretches(springs, record_count, arranged);
    for (size_t s = 0; s < record_count; s++) {
        arranged->stiffness[s] = springs[s].stiffness;
        arranged->damping[s] = springs[s].damping;
        arranged->rest_length[s] = springs[s].rest_length;
    }
}
