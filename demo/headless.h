/* headless: what the demo does without a window. Each returns the program's exit status and says on stderr what failed. */
#ifndef STEADFAST_DEMO_HEADLESS_H
#define STEADFAST_DEMO_HEADLESS_H

#include "options.h"

#define PICTURE_WIDTH 1280
#define PICTURE_HEIGHT 720

/* Runs one scene for scripts: CSV, PNG, a summary on stdout. */
int headless_run(const options *o);

/* Draws each scene (or the one asked for) after a telling time into steadfast-NAME.png. */
int headless_pictures(const options *o);

#endif
