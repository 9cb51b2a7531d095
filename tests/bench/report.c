#include "rows.h"

#define TABLE "%-36s %-6s %8s  %-14s %9s %9s %9s  %12s %8s  %s\n"

void bench_print_header(FILE *file, bool pinned)
{
    fprintf(file, "%s, %s, %s; %s\n", measure_processor(), measure_compiler(), bench_isa(),
            pinned ? "pinned to one core" : "not pinned to a core: this system has no way to");
    fprintf(file, "Median, least and most of interleaved samples; ratios within a round. * marks what misses its target.\n\n");
    fprintf(file, TABLE, "row", "real", "n", "unit", "median", "min", "max", "to reference", "target", "");
}

/* Enough digits for a comparison of percents, few enough to read. */
static void number(char *text, size_t size, double x)
{
    snprintf(text, size, x < 100 ? "%.3f" : "%.1f", x);
}

static bool missed(const bench_row *row) { return row->target > 0 && row->compared > row->target; }

static void comparison_text(const bench_row *row, double value, char *text, size_t size)
{
    if (row->comparison == RATIO)
        snprintf(text, size, "%.2f x", value);
    else if (row->comparison == DIFFERENCE)
        snprintf(text, size, "%+.1f ns", value);
    else
        snprintf(text, size, "%.1f", value);
}

void bench_print_row(FILE *file, const bench_row *row)
{
    char median[24], least[24], most[24], compared[24] = "", target[24] = "", note[32] = "", n[24];

    if (!row->result.measured) {
        fprintf(file, "%-36s %-6s %8zu  left out: no memory or no second core for it\n", row->name, row->precision->name,
                row->n);
        return;
    }
    number(median, sizeof median, row->result.median);
    number(least, sizeof least, row->result.min);
    number(most, sizeof most, row->result.max);
    if (row->comparison != ALONE)
        comparison_text(row, row->compared, compared, sizeof compared);
    if (row->target > 0)
        comparison_text(row, row->target, target, sizeof target);
    snprintf(n, sizeof n, "%zu", row->n);
    if (row->rate > 0)
        snprintf(note, sizeof note, "%.1f %s", row->rate / row->result.median, row->rate_unit);
    fprintf(file, TABLE, row->name, row->precision->name, n, row->unit, median, least, most, compared, target,
            missed(row) ? "*" : note);
    fflush(file);
}

void bench_csv_header(FILE *file)
{
    fprintf(file, "# %s, %s, %s\n", measure_processor(), measure_compiler(), bench_isa());
    fprintf(file, "row,real,n,unit,median,min,max,rounds,comparison,compared,target\n");
}

void bench_csv_row(FILE *file, const bench_row *row)
{
    static const char *const comparisons[] = {"", "ratio", "difference", "value"};

    if (row->result.measured)
        fprintf(file, "\"%s\",%s,%zu,%s,%.6g,%.6g,%.6g,%u,%s,%.6g,%.6g\n", row->name, row->precision->name, row->n, row->unit,
                row->result.median, row->result.min, row->result.max, row->result.rounds, comparisons[row->comparison],
                row->compared, row->target);
}
