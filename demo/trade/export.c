#include "export.h"

#include <math.h>

#include "table.h"

#define DIGITS "%.9g"

void export_csv_head(FILE *csv)
{
    fprintf(csv, "scene,length_unit,time_unit,size [length],duration [time],particles,integrator,precision,steps,step [time],"
                 "accelerations [1/time],cost [ns/particle/time],cost_low,cost_high,end_error [length],largest_error [length],"
                 "error_bound [length],reference_error [length],energy_error,momentum_error,finite,bounded\n");
}

/* Empty where it is not known. */
static void write_error(FILE *csv, const stf_trade_row *row, double error)
{
    if (row->finite && error >= STF_TRADE_MARGIN * row->reference_error)
        fprintf(csv, DIGITS, error);
    fputc(',', csv);
}

static void write_finite(FILE *csv, double number)
{
    if (isfinite(number))
        fprintf(csv, DIGITS, number);
    fputc(',', csv);
}

void export_csv(FILE *csv, const sweep *s)
{
    for (size_t i = 0; i < s->count; i++) {
        const stf_trade_row *row = &s->rows[i];

        fprintf(csv, "%s,%s,%s,%g,%.9g,%lu,%s,%s,%u,%.9g,%.9g,%.6g,%.6g,%.6g,", s->scene->name, s->scene->length_unit,
                s->scene->time_unit, s->scene->size, s->duration, (unsigned long)s->particles, row->integrator,
                row->in_double ? "double" : "float", row->steps, row->step, row->accelerations / s->duration, row->nanoseconds,
                row->nanoseconds_low, row->nanoseconds_high);
        write_error(csv, row, row->end_error);
        write_error(csv, row, row->largest_error);
        write_finite(csv, stf_trade_error_bound(row));
        write_finite(csv, row->reference_error);
        write_finite(csv, row->energy_error);
        write_finite(csv, row->momentum_error);
        fprintf(csv, "%d,%d\n", row->finite, row->bounded);
    }
}

/* JSON has no infinity. */
static void write_number(FILE *json, const char *name, double number, const char *end)
{
    if (isfinite(number))
        fprintf(json, "\"%s\": " DIGITS "%s", name, number, end);
    else
        fprintf(json, "\"%s\": null%s", name, end);
}

static double known(const stf_trade_row *row, double error)
{
    return error >= STF_TRADE_MARGIN * row->reference_error ? error : (double)NAN;
}

static void write_row(FILE *json, const sweep *s, const stf_trade_row *row)
{
    fprintf(json, "{\"integrator\": \"%s\", \"precision\": \"%s\", \"steps\": %u, ", row->integrator,
            row->in_double ? "double" : "float", row->steps);
    write_number(json, "step", row->step, ", ");
    write_number(json, "accelerations", row->accelerations / s->duration, ", ");
    write_number(json, "cost", row->nanoseconds, ", ");
    write_number(json, "cost_low", row->nanoseconds_low, ", ");
    write_number(json, "cost_high", row->nanoseconds_high, ", ");
    write_number(json, "end_error", known(row, row->end_error), ", ");
    write_number(json, "largest_error", known(row, row->largest_error), ", ");
    write_number(json, "error_bound", stf_trade_error_bound(row), ", ");
    write_number(json, "energy_error", row->energy_error, ", ");
    write_number(json, "momentum_error", row->momentum_error, ", ");
    fprintf(json, "\"finite\": %s, \"bounded\": %s, \"on_front\": %s}", row->finite ? "true" : "false",
            row->bounded ? "true" : "false", row->on_front ? "true" : "false");
}

static void write_picks(FILE *json, const sweep *s)
{
    const size_t picks = sizeof table_tolerances / sizeof *table_tolerances;

    for (size_t i = 0; i < picks; i++) {
        const stf_trade_row *pick = stf_trade_cheapest(s->rows, s->count, table_tolerances[i] * s->scene->size);

        fprintf(json, "    {\"tolerance\": %g, \"row\": ", table_tolerances[i]);
        if (pick)
            write_row(json, s, pick);
        else
            fputs("null", json);
        fputs(i + 1 < picks ? "},\n" : "}\n", json);
    }
}

static void write_sweep(FILE *json, const sweep *s)
{
    fprintf(json, "  {\"scene\": \"%s\", \"length_unit\": \"%s\", \"time_unit\": \"%s\", \"particles\": %lu, ", s->scene->name,
            s->scene->length_unit, s->scene->time_unit, (unsigned long)s->particles);
    write_number(json, "size", s->scene->size, ", ");
    write_number(json, "duration", s->duration, ",\n   ");
    fprintf(json, "\"reference\": {\"exact\": %s, \"steps\": %u, ", s->reference.exact ? "true" : "false", s->reference.steps);
    write_number(json, "error", s->reference.error, ", ");
    write_number(json, "energy_error", s->reference.energy, ", ");
    write_number(json, "momentum_error", s->reference.momentum, "},\n   \"picks\": [\n");
    write_picks(json, s);
    fputs("   ],\n   \"rows\": [\n", json);
    for (size_t i = 0; i < s->count; i++) {
        fputs("    ", json);
        write_row(json, s, &s->rows[i]);
        fputs(i + 1 < s->count ? ",\n" : "\n", json);
    }
    fputs("   ]}", json);
}

void export_json(FILE *json, const sweep *sweeps, size_t count)
{
    fputs("[\n", json);
    for (size_t i = 0; i < count; i++) {
        write_sweep(json, &sweeps[i]);
        fputs(i + 1 < count ? ",\n" : "\n", json);
    }
    fputs("]\n", json);
}
