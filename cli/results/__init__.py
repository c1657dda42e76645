"""Results: written in a stage, let take their places, and known again later."""
