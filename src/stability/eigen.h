/* Eigenvalues of small dense matrices, and dot products: what holds no stf_real and so is compiled once. */
#ifndef STEADFAST_SRC_EIGEN_H
#define STEADFAST_SRC_EIGEN_H

#include <complex.h>
#include <stdbool.h>
#include <stddef.h>

/* n is a multiple of 8, as lengths of whole blocks are. */
double stf_dot(size_t n, const double *a, const double *b);

/* The eigenvalues of the n x n matrix `m`, row by row, which is destroyed. */
void stf_eigenvalues(size_t n, double complex *m, double complex *values);

/* The vector of norm 1 that comes closest to m x = 0; `m` is destroyed. */
void stf_null_vector(size_t n, double complex *m, double complex *x);

#endif
