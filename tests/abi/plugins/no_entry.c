/* A shared object, but no policy. */
int unrelated(void);
int unrelated(void) { return 1; }
