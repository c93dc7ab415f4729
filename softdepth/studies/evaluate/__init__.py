"""How accurate the presets are on a folder of scenes, with OpenCV's matchers beside them."""
