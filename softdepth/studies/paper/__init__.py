"""The paper's evaluation, regenerated: Table 2, the pictures of Table 3, Figs. 4 and 5, and the speed."""
