"""Facts that hold for any division of the surface, whichever solver makes it: lower bounds, and
what can be left out."""
